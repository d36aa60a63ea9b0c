# SPDX-License-Identifier: MIT
# The plots of the paper's evaluation: gnuplot -e "folder='out'" bench/paper/plots.gp, from the data in that folder.
load folder."/paper-settings.gp"
set datafile separator "\t"
set grid ytics xtics lt 1 lw 0.5 lc rgb "#cccccc"
set border 3
set tics nomirror

# Okabe and Ito's colours. n-arcs are solid, n-gons dashed.
array colors[6] = ["", "#0072b2", "#56b4e9", "#d55e00", "#009e73", "#cc79a7"]
array dashes[6] = [1, 1, 1, 1, 2, 2]
array shade[5] = ["#d55e00", "#e69f00", "#009e73", "#0072b2", "#cc79a7"]

# Each picture is drawn twice: as SVG, and as PNG.
svg = "svg size 1100,520 dynamic font 'sans-serif,14' noenhanced background 'white'"
png = "pngcairo size 1100,520 font 'sans-serif,11' noenhanced background 'white'"

do for [form in "svg png"] {
    set terminal @svg
    if (form eq "png") { set terminal @png }

    # ------------------------------------------------------------------------ figures 4 and 5
    do for [figure in "4 5"] {
        name = figure eq "4" ? "apart" : "colliding"
        what = figure eq "4" ? "no collision, overlaps" : "collision, contacts"
        set output folder."/paper-figure".figure.".".form
        set multiplot layout 1,2
        do for [isa in "best scalar"] {
            set title (isa eq "best" ? best : isa).": ".what
            set xlabel "arcs or edges\n "
            set ylabel "microseconds for 1,000 checks"
            set xrange [3.5:12.5]
            set yrange [0:*]
            set xtics (4, 6, 8, 10, 12)
            set key outside below center Left reverse samplen 2 maxcols 2
            plot for [c = 2:6] folder."/paper-".name."-".isa.".dat" using ($1 <= 12 ? $1 : NaN):c with linespoints \
                title columnheader(c) lw 2 dt dashes[c] pt 7 ps 0.6 lc rgb colors[c]
        }
        unset multiplot
    }

    # ------------------------------------------------------------------------ up to 64
    set output folder."/paper-scaling.".form
    set multiplot layout 1,2
    set logscale xy
    do for [name in "apart colliding"] {
        set title best.": ".(name eq "apart" ? "no collision, overlaps" : "collision, contacts")
        set xlabel "arcs or edges\n "
        set xrange [3.6:72]
        set yrange [5:2000]
        set xtics (4, 6, 8, 12, 16, 24, 32, 48, 64)
        set key outside below center Left reverse samplen 2 maxcols 2
        plot for [c = 2:6] folder."/paper-".name."-best.dat" using 1:c with linespoints \
            title columnheader(c) lw 2 dt dashes[c] pt 7 ps 0.6 lc rgb colors[c]
    }
    unset multiplot
    unset logscale

    # ------------------------------------------------------------------------ EPA's threshold
    set output folder."/paper-epa.".form
    set multiplot layout 1,2
    set logscale x
    set format x "1e%T"
    set xtics auto
    set xrange [0.2:5e-7]
    set xlabel "threshold, in parts of the sum of both bounding radii"
    set title best.": cost of GJK with EPA, collision scene"
    set ylabel "microseconds for 1,000 checks"
    set yrange [0:*]
    set key inside bottom right Left reverse samplen 2 maxrows 5 maxcols 2
    plot for [c = 2:1 + shapes] folder."/paper-epa-cost.dat" using 1:c with linespoints title columnheader(c) \
            lw 2 pt 7 ps 0.6 lc rgb shade[c - 1], \
        for [c = 2 + shapes:1 + 2 * shapes] folder."/paper-epa-cost.dat" using 1:c with linespoints \
            title columnheader(c) lw 2 dt 2 pt 6 ps 0.6 lc rgb shade[c - 1 - shapes]
    set logscale y
    set format y "1e%T"
    set title "error of the depth, n-arcs"
    set ylabel "median (solid), 99 % are below (dotted)"
    set yrange [1e-7:0.3]
    set key inside top right Left reverse samplen 2 maxrows 6 maxcols 1
    plot for [c = 2:1 + shapes] folder."/paper-epa-median.dat" using 1:c with linespoints title columnheader(c) \
            lw 2 pt 7 ps 0.6 lc rgb shade[c - 1], \
        for [c = 2:1 + shapes] folder."/paper-epa-high.dat" using 1:c with linespoints notitle lw 2 dt 3 pt 6 ps 0.6 \
            lc rgb shade[c - 1], \
        x with lines title "the threshold" lw 1 lc rgb "#000000"
    unset multiplot
    unset logscale
    set format

    # ------------------------------------------------------------------------ warm starts
    set output folder."/paper-warm.".form
    set multiplot layout 1,2
    do for [name in "overlap contact"] {
        set title best.": moving ".moving."-arcs, ".name."s"
        set xlabel "motion in a frame, in parts of the size and in radians\n "
        set ylabel "microseconds for 1,000 checks"
        set xrange [-0.5:6.5]
        set yrange [0:*]
        set key outside below center Left reverse samplen 2 maxcols 2
        plot for [c = 2:(name eq "overlap" ? 4 : 5)] folder."/paper-warm-".name.".dat" using 0:c:xtic(1) \
            with linespoints title columnheader(c) lw 2 dt dashes[c == 3 || c == 5 ? 6 : 2] pt 7 ps 0.6 \
            lc rgb (c < 4 ? colors[4] : colors[2])
    }
    unset multiplot
    unset output
}
