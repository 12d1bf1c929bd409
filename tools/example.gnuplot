# What the pictures of the examples share: data of the decks, axes, colours.
R = 10.0; P = 1000.0; E = 210e3
root(x) = x > 0 ? sqrt(x) : 0
set grid linewidth 0.5 linecolor rgb '#c8c8c8'
set border 3
set tics nomirror
set xlabel offset 0,0.6
set key outside bottom center horizontal spacing 1.1
set bmargin 6
set style line 1 pt 7 ps 0.5 lc rgb '#1b4f9c'
set style line 2 pt 7 ps 0.5 lc rgb '#b5432a'
set style line 3 lw 1.5 lc rgb '#1b4f9c'
set style line 4 lw 1.5 lc rgb '#b5432a'
set style line 5 lw 1 dt 2 lc rgb '#555555'
set samples 800
