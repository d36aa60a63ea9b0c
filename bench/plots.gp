# SPDX-License-Identifier: MIT
# The plot of the benchmark: gnuplot -e "folder='out'" bench/plots.gp, from arcs.dat in that folder.
set terminal svg size 800,520 dynamic font "sans-serif,14" noenhanced background "white"
set datafile separator "\t"
set datafile missing "?"
set grid ytics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3
set tics nomirror
set key outside right top Left reverse samplen 4 width -4

# Okabe and Ito's colours; ours (columns 2 to 5) are solid and thick.
array colors[9] = ["", "#0072b2", "#56b4e9", "#d55e00", "#e69f00", "#009e73", "#88ccaa", "#cc79a7", "#8a2be2"]

data = folder."/arcs.dat"
if (system("test -s ".data." && echo yes") eq "yes") {
    set output folder."/bench-arcs.svg"
    set title "One thread, a settled pile of 30,000 bodies"
    set xlabel "arcs of each shape (edges, for polygons)"
    set ylabel "nanoseconds per pair"
    set logscale y
    set xrange [3.5:16.5]
    set yrange [5:*]
    set xtics (4, 6, 8, 12, 16)
    plot for [c = 2:5] data using 1:c with linespoints title columnheader(c) lw 3 pt 7 ps 0.6 lc rgb colors[c], \
        for [c = 6:9] data using 1:c with linespoints title columnheader(c) lw 1.5 pt 6 ps 0.6 dt 2 lc rgb colors[c]
}
