# Pressure E (alpha T - gap) as the ring heats, times exp(-t/tau) in the hot
# time; then it cools, against the strain that has relaxed.
E = 2e5; alpha = 1.2e-5; gap = 1e-3; tau = 1000.
heat(t) = t < 1 ? 100*t : t < 1 + tau ? 100 : 100*(2 + tau - t)
cut(x) = x > 0 ? x : 0
area = pi*(10.5**2 - 10**2)
hot = alpha*100 - gap
lost(t) = t < 1 ? 0 : hot*(1 - exp(-((t < 1 + tau ? t - 1 : tau))/tau))
p(t) = E*cut(alpha*heat(t) - gap - lost(t))
set title 'Seal: closes hot, relaxes, opens when it cools'
set xlabel 'time (heating and cooling take 1)'
set ylabel 'pressure on the lid'
set xrange [0:1010]
set yrange [0:45]
set samples 4000
plot p(x) ls 3 title 'closed form', \
     table using 1:($2/area) with points ls 2 title 'Protis'
