# Lubkin: with s in contact radii the middle turns as if discs of all radii
# from c to 1 turned by (4/pi^2) C E/s ds, E of the modulus sqrt(1 - s^2).
nu = 0.3; mu = 0.4; G = E/(2*(1 + nu))
a = (3*P*R*(1 - nu**2)/(4*E))**(1/3.0); p0 = 1.5*P/(pi*a*a)
n = 200
e_of(s) = s < 1 ? EllipticE(sqrt(1 - s*s)) : pi/2
ke(s) = s < 1 ? EllipticK(sqrt(1 - s*s)) - e_of(s) : 0
angle(s) = 3*mu*P/(4*pi*G*a*a)*ke(s)
torque(c) = 4*mu*P*a/pi*(c**3*ke(c) + 3*sum [i=0:n-1] \
  ((c + (1 - c)*(i + 0.5)/n)**2*ke(c + (1 - c)*(i + 0.5)/n)*(1 - c)/n))
low(r, c) = sqrt(c*c - r*r)
v(r, c, i) = low(r, c) + (sqrt(1 - r*r) - low(r, c))*(i + 0.5)/n
disc(r, c) = 2/pi*r*sum [i=0:n-1] ((sqrt(1 - r*r) - low(r, c))/n* \
  e_of(sqrt(r*r + v(r, c, i)**2))/(r*r + v(r, c, i)**2))
p(r) = p0*root(1 - (r/a)**2)
q(r) = mu*(r < 0.5*a ? p0*disc(r/a, 0.5) : p(r))
set multiplot layout 1,2 title 'Torsion of a pressed sphere (Lubkin), c = a/2'
set xlabel 'r [mm]'
set ylabel 'traction on the body [MPa]'
set xrange [0:1.3*a]
set yrange [0:1.1*p0]
plot p(x) ls 3 title 'Hertz', \
     table using (sqrt($1**2 + $2**2)):3 with points ls 1 title 'pressure', \
     q(x) ls 4 title 'Lubkin', table using (sqrt($1**2 + $2**2)): \
       (sqrt($4**2 + $5**2)) with points ls 2 title 'shear traction', \
     mu*p(x) ls 5 title 'mu p'
set parametric
set trange [0.45:1]
set samples 60
set xrange [0:*]
set yrange [0:3*pi*mu*P*a/16*1.05]
set xlabel 'angle [rad]'
set ylabel 'torque [N mm]'
set xtics 0.002
plot angle(t), torque(t) ls 3 title 'Lubkin', \
     loop using 1:2 with points ls 2 title 'torque', \
     (t - 0.45)/0.55*angle(0.45), 3*pi*mu*P*a/16 ls 5 title 'full slip, 3 pi mu P a/16'
unset multiplot
