# The same bar by Heun's method in this script: 2000 steps a cycle.
E = 1e5; sy = 60.; K = 150.; n = 3.; Q = 20.; b = 50.
C1 = 2e4; g1 = 100.; C2 = 5e3; g2 = 20.; amp = 5e-3
strain(t) = amp*sin(2*pi*t)
over(t, ep, p, a1, a2) = (abs(E*(strain(t) - ep) - C1*a1 - C2*a2) - sy \
  - Q*(1 - exp(-b*p)))/K
rate(t, ep, p, a1, a2) = over(t, ep, p, a1, a2) > 0 ? \
  over(t, ep, p, a1, a2)**n : 0
way(t, ep, a1, a2) = sgn(E*(strain(t) - ep) - C1*a1 - C2*a2)
steps = 2000; cycles = 10; every = 10
array eps_[cycles*steps/every]
array sig_[cycles*steps/every]
ep = 0.; p = 0.; a1 = 0.; a2 = 0.; h = 1./steps
do for [i=1:cycles*steps] {
  t = (i - 1)*h
  r = rate(t, ep, p, a1, a2); d = r*way(t, ep, a1, a2)
  ep_ = ep + h*d; p_ = p + h*r
  a1_ = a1 + h*(d - g1*a1*r); a2_ = a2 + h*(d - g2*a2*r)
  r2 = rate(t + h, ep_, p_, a1_, a2_); d2 = r2*way(t + h, ep_, a1_, a2_)
  ep = ep + h/2*(d + d2); p = p + h/2*(r + r2)
  a1 = a1 + h/2*(d - g1*a1*r + d2 - g1*a1_*r2)
  a2 = a2 + h/2*(d - g2*a2*r + d2 - g2*a2_*r2)
  if (i % every == 0) {
    eps_[i/every] = strain(i*h); sig_[i/every] = E*(strain(i*h) - ep)
  }
}
set multiplot layout 1,2 title "Chaboche's law: ten cycles of 0.5 % strain"
set xlabel 'strain [%]'
set ylabel 'stress [MPa]'
set xrange [-0.6:0.6]
set yrange [-200:200]
plot eps_ using (100*eps_[$1]):(sig_[$1]) with lines ls 3 \
       title 'differential equations of the bar', \
     table using (100*$2):3 every 4 with points ls 2 title 'Protis'
set xlabel 'time [s]'
set xrange [0:10]
plot eps_ using ($1*every*h):(sig_[$1]) with lines ls 3 notitle, \
     table using 1:3 every 4 with points ls 2 notitle
unset multiplot
