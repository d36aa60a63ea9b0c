# SPDX-License-Identifier: MIT
# The energies of the case pile.json, and its contacts: gnuplot -e "folder='out/dem/pile'" pile.gp
set datafile separator ","
set terminal pngcairo size 1000,420 font 'sans-serif,10' noenhanced background 'white'
set output folder."/energies.png"
set grid lt 1 lw 0.5 lc rgb "#cccccc"
set border 3
set tics nomirror
set xlabel "time, s"
file = folder."/pile.csv"
set multiplot layout 1,2
set ylabel "energy, mJ"
set key center right
plot file using 2:(1e3 * $4) skip 1 with lines lw 1.5 lc rgb "#0072b2" title "potential" \
    , file using 2:(1e3 * $6) skip 1 with lines lw 1.5 lc rgb "#d55e00" title "lost by damping" \
    , file using 2:(1e3 * $7) skip 1 with lines lw 1.5 lc rgb "#009e73" title "lost by friction" \
    , file using 2:(1e3 * $3) skip 1 with lines lw 1.5 lc rgb "#000000" title "kinetic"
set ylabel "contacts of a grain"
set key bottom right
plot file using 2:14 skip 1 with lines lw 1.5 lc rgb "#0072b2" notitle
unset multiplot
