# SPDX-License-Identifier: MIT
# The biaxial tests and the hoppers: gnuplot -e "folder='out/dem'" plots.gp
set terminal pngcairo size 1000,420 font 'sans-serif,10' noenhanced background 'white'
set grid lt 1 lw 0.5 lc rgb "#cccccc"
set border 3
set tics nomirror
names = "smooth disc sand"
titles = "'discs, no friction' 'discs, 0.5' 'sand, 0.5'"
array colors[3] = ["#0072b2", "#d55e00", "#009e73"]

set output folder."/biaxial.png"
set multiplot layout 1,2
set xlabel "strain, %"
set ylabel "sine of the angle of friction"
set key bottom right
set yrange [0:*]
plot for [k = 1:3] folder."/biaxial-".word(names, k)."/biaxial.dat" using (100 * $1):(($2 - $3) / ($2 + $3)) \
    with lines lw 1.5 lc rgb colors[k] title word(titles, k)
set ylabel "loss of area, %"
set yrange [*:*]
set key bottom left
plot for [k = 1:3] folder."/biaxial-".word(names, k)."/biaxial.dat" using (100 * $1):(100 * $4) \
    with lines lw 1.5 lc rgb colors[k] title word(titles, k)
unset multiplot

set output folder."/hopper.png"
set terminal pngcairo size 560,420 font 'sans-serif,10' noenhanced background 'white'
set xlabel "opening, grains"
set ylabel "flow^(2/3)"
set key top left
set xrange [0:16]
set yrange [0:*]
c = 1.5
k = 1
f(x) = c * (x - k)
set fit quiet nolog
fit f(x) folder."/hopper/hopper.dat" using 1:3 via c, k
plot f(x) with lines lw 1.5 lc rgb "#999999" title sprintf("%.2f (D - %.2f)", c, k), \
    folder."/hopper/hopper.dat" using 1:3 with points pt 7 ps 1.3 lc rgb "#0072b2" title "flow of discs"
