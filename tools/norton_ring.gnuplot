# Lame at once, the steady state of Norton's law at the end: n = 5, p = 100.
p = 100.; n = 5.
power(r, n) = (2./r)**(2/n)
rr(r, n) = -p*(power(r, n) - 1)/(2**(2/n) - 1)
tt(r, n) = p*(1 - (1 - 2/n)*power(r, n))/(2**(2/n) - 1)
set title 'Tube under inner pressure: from Lame to steady creep, n = 5'
set xlabel 'radius'
set ylabel 'stress [MPa]'
set xrange [1:2]
set yrange [-110:180]
plot tt(x, 1.) ls 5 title 'hoop, elastic (Lame)', \
     rr(x, 1.) ls 5 notitle, \
     tt(x, n) ls 3 title 'hoop, steady creep', \
     rr(x, n) ls 4 title 'radial, steady creep', \
     loop using 1:2 with points pt 6 ps 0.5 lc rgb '#555555' \
       title 'Protis at once', \
     loop using 1:3 with points pt 6 ps 0.5 lc rgb '#555555' notitle, \
     table using 1:2 with points ls 1 title 'Protis at the end', \
     table using 1:3 with points ls 2 notitle
