# SPDX-License-Identifier: MIT
# The plots of the paper's evaluation: gnuplot -e "folder='out'" bench/paper/plots.gp, from the data in that folder.
load folder."/paper-settings.gp"
set datafile separator "\t"
set grid ytics xtics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3
set tics nomirror

# Okabe and Ito's colours. n-arcs are solid, n-gons dashed; samples in keys are long enough to show it.
array colors[6] = ["", "#0072b2", "#56b4e9", "#d55e00", "#009e73", "#cc79a7"]
array shade[5] = ["#d55e00", "#e69f00", "#009e73", "#0072b2", "#cc79a7"]
solid = 1
dashed = 11
dotted = 12
set dashtype 11 (10, 6)
set dashtype 12 (2, 5)
array dashes[6] = [solid, solid, solid, solid, dashed, dashed] # by column
array warm[4] = [solid, solid, dashed, solid]

# As a reader calls them.
name_of(isa) = isa eq "avx512" ? "AVX-512" : isa eq "avx2" ? "AVX2" : isa eq "sse41" ? "SSE4.1" : isa eq "neon" ? "NEON" : "plain C"
figure_4 = "Do they collide? No pair does"
figure_5 = "Depth, normal and point; all pairs collide"

set terminal svg size 1100,540 dynamic font "sans-serif,14" noenhanced background "white"

# ------------------------------------------------------------------------ figures 4 and 5
do for [figure in "4 5"] {
    name = figure eq "4" ? "apart" : "colliding"
    set output folder."/paper-figure".figure.".svg"
    set multiplot layout 1,2 title (figure eq "4" ? figure_4 : figure_5)
    do for [isa in "best scalar"] {
        set title (isa eq "best" ? name_of(best) : "Plain C, one pair after the other")
        set xlabel "arcs or edges\n "
        set ylabel "microseconds for 1,000 checks"
        set xrange [3.5:12.5]
        set yrange [0:*]
        set xtics (4, 6, 8, 10, 12)
        set key outside below center Left reverse samplen 6 maxcols 2
        plot for [c = 2:6] folder."/paper-".name."-".isa.".dat" using ($1 <= 12 ? $1 : NaN):c with linespoints \
            title columnheader(c) lw 2 dt dashes[c] pt 7 ps 0.6 lc rgb colors[c]
    }
    unset multiplot
}

# ------------------------------------------------------------------------ up to 64
set output folder."/paper-scaling.svg"
set multiplot layout 1,2 title "Up to 64 arcs or edges, ".name_of(best)
set logscale xy
do for [name in "apart colliding"] {
    set title (name eq "apart" ? figure_4 : figure_5)
    set xlabel "arcs or edges\n "
    set xrange [3.6:72]
    set yrange [5:2000]
    set xtics (4, 6, 8, 12, 16, 24, 32, 48, 64)
    set key outside below center Left reverse samplen 6 maxcols 2
    plot for [c = 2:6] folder."/paper-".name."-best.dat" using 1:c with linespoints \
        title columnheader(c) lw 2 dt dashes[c] pt 7 ps 0.6 lc rgb colors[c]
}
unset multiplot
unset logscale

# ------------------------------------------------------------------------ EPA's threshold
set output folder."/paper-epa.svg"
set multiplot layout 1,2 title "GJK with EPA where all pairs collide, by EPA's threshold"
set logscale x
set format x "1e%T"
set xtics auto
set xrange [0.2:5e-7]
set xlabel "threshold, in parts of the sum of both bounding radii\n "
set title "What it costs, ".name_of(best)." (n-arcs solid, n-gons dashed)"
set ylabel "microseconds for 1,000 checks"
set yrange [0:*]
set key outside below center Left reverse samplen 6 maxrows 5 maxcols 2
plot for [c = 2:1 + shapes] folder."/paper-epa-cost.dat" using 1:c with linespoints title columnheader(c) \
        lw 2 pt 7 ps 0.6 lc rgb shade[c - 1], \
    for [c = 2 + shapes:1 + 2 * shapes] folder."/paper-epa-cost.dat" using 1:c with linespoints \
        title columnheader(c) lw 2 dt dashed pt 6 ps 0.6 lc rgb shade[c - 1 - shapes]
set logscale y
set format y "1e%T"
set title "What it buys: the error of the depth of n-arcs"
set ylabel "in parts of the same"
set yrange [1e-7:0.3]
set key outside below center Left reverse samplen 6 maxrows 5 maxcols 2
plot for [c = 2:1 + shapes] folder."/paper-epa-median.dat" using 1:c with linespoints \
        title columnheader(c).", median" lw 2 pt 7 ps 0.6 lc rgb shade[c - 1], \
    folder."/paper-epa-high.dat" using 1:2 with linespoints title "99 % are below" lw 2 dt dotted pt 6 ps 0.6 \
        lc rgb shade[1], \
    for [c = 3:1 + shapes] folder."/paper-epa-high.dat" using 1:c with linespoints notitle lw 2 dt dotted pt 6 \
        ps 0.6 lc rgb shade[c - 1], \
    x with lines title "the threshold" lw 1 lc rgb "#000000"
unset multiplot
unset logscale
set format

# ------------------------------------------------------------------------ warm starts
set output folder."/paper-warm.svg"
set multiplot layout 1,2 title \
    "Moving ".moving."-arcs from frame to frame, half of the pairs colliding, ".name_of(best)
do for [name in "overlap contact"] {
    set title (name eq "overlap" ? "Do they collide?" : "Depth, normal and point of those that collide")
    set xlabel "motion in a frame, in parts of the size and in radians\n "
    set ylabel "microseconds for 1,000 checks"
    set xrange [-0.5:6.5]
    set yrange [0:*]
    set key outside below center Left reverse samplen 6 maxcols 2
    plot for [c = 2:4] folder."/paper-warm-".name.".dat" using 0:c:xtic(1) \
        with linespoints title columnheader(c) lw 2 dt warm[c] pt 7 ps 0.6 \
        lc rgb (c < 4 ? colors[4] : colors[2])
}
unset multiplot
unset output
