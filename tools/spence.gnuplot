# Spence: a and c of theory as lines; nu = 0.3, mu = 0.2.
a_h = sqrt(4*P*R*0.91/(pi*E)); p0 = 2*P/(pi*a_h)
a = 0.98272*a_h; c = 0.36039*a
set title 'Indentation with friction (Spence), nu = 0.3, mu = 0.2'
set xlabel 'x [mm]'
set ylabel 'traction on the body [MPa]'
set xrange [0:1.15*a_h]
set yrange [0:*]
set arrow 1 from c, graph 0 to c, graph 0.6 nohead ls 5
set arrow 2 from a, graph 0 to a, graph 0.6 nohead ls 5
set label 1 'c = 0.36039 a' at c, graph 0.64 center
set label 2 'a = 0.98272 a_H' at a, graph 0.64 center
set label 3 '1.0818 p_0' at 0.05*a_h, 1.0818*p0 offset 0,0.8
plot p0*root(1 - (x/a_h)**2) ls 5 title 'pressure without friction (Hertz)', \
     table using 1:2 with points ls 1 title 'pressure', \
     table using 1:(abs($3)) with points ls 2 title 'shear traction', \
     table using 1:($5 > 0 ? $4*$2/$5 : 1/0) with lines ls 4 title 'mu p'
