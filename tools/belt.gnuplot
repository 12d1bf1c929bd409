# Sliding with coupling: nu = 0.3, mu from 0.2 to 0.5.
mu = 0.5; nu = 0.3; Es = E/(1 - nu**2)
e = atan(mu*(1 - 2*nu)/(2 - 2*nu))/pi; l = sqrt(4*P*R/(pi*Es*(1 - 4*e*e)))
s(x) = x + 2*e*l
p(x) = abs(s(x)) < l ? Es*cos(pi*e)/(2*R)*(l - s(x))**(0.5 + e)* \
  (l + s(x))**(0.5 - e) : 0
a_h = sqrt(4*P*R/(pi*Es))
set multiplot layout 1,2 title 'Roller that drags a half plane, nu = 0.3'
set xlabel 'x [mm]'
set ylabel 'traction on the body [MPa]'
set xrange [-1.2*l:1.2*l]
set yrange [0:*]
plot 2*P/(pi*a_h)*root(1 - (x/a_h)**2) ls 5 title 'without friction (Hertz)', \
     p(x) ls 3 title 'closed form, mu = 0.5', \
     table using 1:2 with points ls 1 title 'pressure', mu*p(x) ls 4 notitle, \
     table using 1:3 with points ls 2 title 'shear traction'
set xrange [0:2.1]
set yrange [0:0.6]
set xlabel 'time [s]'
set ylabel 'tangential over normal force'
plot 0.2 + 0.3*(x > 1 ? x - 1 : 0) ls 3 title 'mu(t)', \
     loop using 1:($3/$2) with points ls 2 title 'T/N'
unset multiplot
