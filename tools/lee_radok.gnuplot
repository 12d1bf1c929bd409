# a^2 = 4 P R (1 + t/tau)/(pi E*); the pressure is the integral over the past,
# by the substitution a(s) for the time, after the jump to a(0).
P = 1.; E = 1e3; tau = 2.; Es = E/0.91; end = 10.
a2(t) = 4*P*R*(1 + t/tau)/(pi*Es)
kernel(x, s, t) = exp(-(t - s)/tau)*a2(0)/tau/2/root(a2(s) - x*x)
# from the time s0 at which the contact reaches x, s = s0 + w^2
start(x) = x*x > a2(0) ? (x*x/a2(0) - 1)*tau : 0
n = 400
jump(x, t) = exp(-t/tau)*root(a2(0) - x*x)
past(x, t) = sum [i=0:n-1] (2*mid(x, t, i)*sqrt(t - start(x))/n \
  *kernel(x, start(x) + mid(x, t, i)**2, t))
mid(x, t, i) = (i + 0.5)/n*sqrt(t - start(x))
p(x, t) = x*x < a2(t) ? Es/(2*R)*(jump(x, t) + past(x, t)) : 0
set multiplot layout 1,2 title 'Maxwell cylinder that sinks onto a plane (Lee, Radok)'
set xlabel 'time'
set ylabel 'half-width of the contact'
set xrange [0:10]
set yrange [0:0.3]
plot sqrt(a2(x)) ls 3 title 'closed form', \
     loop using ($1 - 1):2 with points ls 2 title 'Protis'
set xlabel 'x'
set ylabel 'pressure'
set xrange [0:0.3]
set yrange [0:6.5]
set samples 300
plot Es/(2*R)*root(a2(0) - x*x) ls 5 title 'at once (Hertz)', \
     p(x, end) ls 3 title 'closed form, t = 5 tau', \
     table using 1:2 with points ls 2 title 'Protis'
unset multiplot
