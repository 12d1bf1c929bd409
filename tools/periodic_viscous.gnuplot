# The bar by small steps in this script: in contact ds/dt = E dd/dt - s/tau,
# open s = q while the end creeps to meet the floor at -d.
E = 1e3; q = 1.; tau = 0.5; rise = 3e-3
down(t) = rise*sin(2*pi*t)
fluid(t) = (1 + 0.5*cos(2*pi*t))/tau
steps = 2000; periods = 6; every = 10
array f_[periods*steps/every]
array g_[periods*steps/every]
ei = 0.; h = 1./steps
do for [i=1:periods*steps] {
  t = i*h
  s = E*(down(t) - ei)
  if (s > q) { s = q }
  ei = (ei + h/2*fluid(t)*s/E)
  s = E*(down(t) - ei)
  if (s > q) { s = q }
  ei = ei + h/2*fluid(t)*s/E
  if (i % every == 0) {
    f_[i/every] = q - s; g_[i/every] = down(t) - ei - s/E
  }
}
set multiplot layout 1,2 title 'Maxwell bar on a floor that moves, periodic relaxation time'
set xlabel 'periods'
set ylabel 'pressure on the floor'
set xrange [0:6]
set yrange [0:*]
plot f_ using ($1*every*h):(f_[$1]) with lines ls 3 \
       title 'differential equation of the bar', \
     table using 1:2 every 2 with points ls 2 title 'Protis', \
     3.2950371 ls 5 title 'limit cycle'
set xlabel 'floor moved down [10^{-3}]'
set ylabel 'pressure on the floor'
set xrange [-3.2:3.2]
set yrange [0:*]
plot f_ using (1e3*down($1*every*h)):(f_[$1]) with lines ls 3 \
       title 'from rest', \
     table using (1e3*down($1)):($1 > 19 ? $2 : 1/0) with points ls 2 \
       title 'period 20'
unset multiplot
