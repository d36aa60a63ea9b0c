# SPDX-License-Identifier: MIT
# The plot of the study: gnuplot -e "folder='out'" bench/fit_study/plots.gp, from the data in that folder.
set datafile separator "\t"
set terminal pngcairo size 1200,460 font 'sans-serif,10' noenhanced background 'white'
set output folder."/fit-straight.png"
set grid xtics ytics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3
set tics nomirror
set xrange [-4:104]
set xlabel "straight part of the hull's perimeter, %"

# Okabe and Ito's colours.
array colors[7] = ["#000000", "#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"]
array shapes[7] = [7, 5, 9, 11, 13, 15, 1]

set multiplot layout 1,3 margins 0.05,0.99,0.25,0.92 spacing 0.045
do for [c = 3:5] {
    n = 2 * c - 2
    set title sprintf("%d-arc / %d-gon", n, n)
    if (c == 3) { set ylabel "ratio of the areas" } else { unset ylabel }
    set yrange [*<0.95:1.05<*]
    set offsets 0, 0, graph 0.05, graph 0.05
    if (c == 4) {
        set key at screen 0.52, screen 0.06 center maxrows 1 samplen 1 width -2 Left reverse
    } else {
        unset key
    }
    plot 1 with lines notitle lw 1.5 lc rgb "#666666", \
        for [k = 0:6] folder."/fit-study.dat" index k using (100 * column(2)):(column(c)) with points \
            title columnheader(1) pt shapes[k + 1] ps 1.2 lc rgb colors[k + 1]
}
unset multiplot
unset output
