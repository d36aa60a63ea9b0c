# SPDX-License-Identifier: MIT
# The biaxial tests, the hoppers, slopes and collisions: gnuplot -e "folder='out/dem'" plots.gp
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

# A slope: speeds against time on the left, accelerations against friction on the right; lines are theory.
set output folder."/rolling.png"
set terminal pngcairo size 1000,420 font 'sans-serif,10' noenhanced background 'white'
set multiplot layout 1,2
down = 0.5
across = sqrt(3) / 2
a(mu) = mu < down / across / 3 ? down - mu * across : down * 2 / 3
rim(mu) = mu < down / across / 3 ? 2 * mu * across : down * 2 / 3
set xrange [0:10.4]
set yrange [0:*]
set xlabel "time"
set ylabel "speed"
set key top left
file = folder."/rolling/speeds.dat"
array frictions[4] = [0, 0.1, 0.18, 0.4]
array shown[4] = [2, 4, 6, 10]
array shades[4] = ["#0072b2", "#009e73", "#cc79a7", "#d55e00"]
plot for [k = 1:4] a(frictions[k]) * x with lines lw 1.5 lc rgb shades[k] notitle \
    , for [k = 1:4] file using 1:shown[k] with points pt 7 ps 1 lc rgb shades[k] \
        title sprintf(k == 1 ? "no friction" : k == 4 ? "friction %g: rolls" : "friction %g: slides", frictions[k])
set xrange [0:0.52]
set yrange [-0.02:0.55]
set xlabel "friction"
set ylabel "acceleration / gravity"
set key bottom right
set samples 1000
file = folder."/rolling/rolling.dat"
plot a(x) with lines lw 1.5 lc rgb "#999999" notitle, rim(x) with lines lw 1.5 lc rgb "#999999" dt 2 notitle \
    , file using 1:2 with points pt 7 ps 1.3 lc rgb "#0072b2" title "disc, along the slope" \
    , file using 1:3 with points pt 6 ps 2 lc rgb "#d55e00" title "circle of eight arcs, along the slope" \
    , file using 1:4 with points pt 7 ps 1.3 lc rgb "#009e73" title "disc, its rim" \
    , file using 1:5 with points pt 6 ps 2 lc rgb "#cc79a7" title "circle of eight arcs, its rim"
unset multiplot

# Collisions: restitutions on the left, their errors against the time step on the right.
set output folder."/collision.png"
set terminal pngcairo size 1000,420 font 'sans-serif,10' enhanced background 'white'
set multiplot layout 1,2
set xrange [0:1.05]
set yrange [0:1.05]
set xlabel "restitution that is given"
set ylabel "restitution that is found"
set key top left
file = folder."/collision/restitution.dat"
plot x with lines lw 1.5 lc rgb "#999999" notitle \
    , file using 1:2 with points pt 7 ps 1.3 lc rgb "#0072b2" title "linear" \
    , file using 1:3 with points pt 6 ps 2 lc rgb "#d55e00" title "Hertz" \
    , file using 1:4 with points pt 2 ps 2 lw 1.5 lc rgb "#009e73" title "Hertz, a tenth of the speed"
set logscale xy
set format y "10^{%T}"
set xrange [8:800]
set yrange [3e-8:2]
set xlabel "steps a contact"
set ylabel "error of restitution, root mean square"
set key top right maxrows 3
file = folder."/collision/order.dat"
plot 0.3 / x with lines lw 1.5 lc rgb "#999999" title "first order" \
    , file using 1:3 with points pt 7 ps 1.3 lc rgb "#0072b2" title "linear, 0.5" \
    , file using 1:5 with points pt 6 ps 2 lc rgb "#d55e00" title "Hertz, 0.5" \
    , 1.4 / x ** 3 with lines lw 1.5 lc rgb "#999999" dt 2 title "third order" \
    , file using 1:2 with points pt 5 ps 1.2 lc rgb "#009e73" title "linear, 1" \
    , file using 1:4 with points pt 4 ps 1.8 lc rgb "#cc79a7" title "Hertz, 1"
unset multiplot
