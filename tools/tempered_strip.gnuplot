# Stress along the strip in its middle; the curve is that of profile.txt.
set title 'Tempered strip: stress left over half the height'
set xlabel 'y [mm], 0 in the middle, 1 at the surface'
set ylabel 'stress along the strip [MPa]'
set xrange [0:1]
plot 'input/tempered_strip/profile.txt' using 1:2 with lines ls 3 \
       title 'differential equations over the height', \
     table using 1:2 with points ls 2 title 'Protis', 0 ls 5 notitle
