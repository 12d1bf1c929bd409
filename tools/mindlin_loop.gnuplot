# Cattaneo and Mindlin: nu = 0.3, mu = 0.3, Q = mu P/2; c/a = sqrt(1/2).
a = sqrt(4*P*R*0.91/(pi*E)); p0 = 2*P/(pi*a); c = a*sqrt(0.5); mu = 0.3
p(x) = p0*root(1 - (x/a)**2)
q(x) = mu*(p(x) - p0*c/a*root(1 - (x/c)**2))
set multiplot layout 1,2 title 'Pressed, sheared to and fro (Cattaneo, Mindlin)'
set xlabel 'x [mm]'
set ylabel 'traction on the body [MPa]'
set xrange [-1.2*a:1.2*a]
set yrange [0:1.1*p0]
plot p(x) ls 3 title 'Hertz', table using 1:2 with points ls 1 \
       title 'pressure', \
     q(x) ls 4 title 'Cattaneo', table using 1:3 with points ls 2 \
       title 'shear traction', \
     mu*p(x) ls 5 title 'mu p'
set xrange [*:*]
set yrange [*:*]
set xlabel 'mean displacement of the contact nodes [nm]'
set ylabel 'tangential force [N/mm]'
plot loop using (1e6*$1):2 with linespoints ls 1 \
       title 'shear, then one cycle: heat 0.01412 N mm/mm'
unset multiplot
