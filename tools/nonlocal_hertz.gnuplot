# Average R(p) of the pressure of Hertz, rho = 0.2 a, by the midpoint rule. The
# cylinder rocks a little: the closed form stands at the middle of the forces.
MU = 0.05
a = sqrt(4*P*R*0.91/(pi*E)); p0 = 2*P/(pi*a); rho = 0.2*a
n = 200
stats table using ($1*$5) name 'moment' nooutput
stats table using 5 name 'force' nooutput
middle = moment_sum/force_sum
bump(s) = exp(1/(s*s - 1))/0.44399381616808
p(x) = p0*root(1 - (x/a)**2)
average(x) = sum [i=0:n-1] (2.0/n*bump((i + 0.5)*2/n - 1)* \
  p(x + rho*((i + 0.5)*2/n - 1)))
set title 'Cylinder that slides, nonlocal friction of radius 0.2 a'
set xlabel 'x [mm]'
set ylabel 'pressure [MPa]'
set xrange [-1.25*a:1.25*a]
set yrange [0:1.1*p0]
set y2range [0:1.1*MU*p0]
set ytics nomirror
set y2tics
set border 11
set y2label 'shear [MPa]'
plot p(x - middle) ls 3 title 'Hertz; mu p', \
     table using 1:2 with points ls 1 title 'pressure', \
     (abs(x - middle) < a ? MU*average(x - middle) : 1/0) axes x1y2 ls 4 \
       title 'mu R(p)', \
     table using 1:(abs($3)) axes x1y2 with points ls 2 title 'shear traction'
