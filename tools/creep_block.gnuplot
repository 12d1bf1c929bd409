# Under its loads all displacements double in one relaxation time; held, the
# forces of the floor fall as exp(-t/tau) from the end of the press (t = 1).
tau = 4.0
stats held using 2 every ::4::4 nooutput
normal = STATS_min
stats held using 3 every ::4::4 nooutput
friction = STATS_min
fall(t) = t < 1 ? 1/0 : exp(-(t - 1)/tau)
set multiplot layout 1,2 title 'Maxwell block on a rough floor'
set xlabel 'x [mm]'
set ylabel 'displacement along the floor [mm]'
plot loop using 1:2 with lines ls 5 title 'pressed, t = 0', \
     loop using 1:(2*$2) with lines ls 3 title 'twice that', \
     table using 1:2 with points ls 2 title 'Protis, t = tau'
set xlabel 'time [s]'
set ylabel 'force on the held block [N/mm]'
set xrange [0:11]
plot normal*fall(x) ls 3 title 'closed form', friction*fall(x) ls 3 notitle, \
     held using 1:2 with points ls 2 title 'Protis, normal', \
     held using 1:3 with points ls 1 title 'Protis, friction'
unset multiplot
