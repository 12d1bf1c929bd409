# Uniform pressure and shear P0 - lambda beta and mu times it; u_x on AB.
NU = 0.1; MU = 1.0; MU0 = 2.5; P0 = 0.01
lambda = NU/((1 + NU)*(1 - 2*NU)); mu_c = sqrt((1 - NU)/NU)
beta(mu) = P0*(mu - MU0)/(lambda*(mu - mu_c))
set multiplot layout 1,2 title 'Triangle of Hild, nu = 0.1, mu = 1'
set xlabel 'x'
set ylabel 'traction on the body'
set xrange [0:1]
set yrange [0:0.004]
plot P0 - lambda*beta(MU) ls 3 title 'P0 - lambda beta', \
     table using 1:2 with points pt 7 ps 0.7 lc rgb '#1b4f9c' title 'pressure', \
     MU*(P0 - lambda*beta(MU)) ls 5 title 'mu (P0 - lambda beta)', \
     table using 1:(abs($3)) with points pt 6 ps 1.2 lc rgb '#b5432a' \
       title 'shear traction'
set ylabel 'displacement of the base'
set yrange [-0.1:0]
plot 0.002*x - 0.02 + beta(MU)*(x - 1) ls 3 title 'a x + c + beta (x - 1)', \
     table using 1:6 with points pt 7 ps 1 lc rgb '#1b4f9c' title 'computed'
unset multiplot
