# SPDX-License-Identifier: MIT
# The angle of repose of the case pile.json: awk -F , -v half=0.06 -f repose.awk pile-000048.csv, with half of the table's
# width. The table's grains make the surface: the highest point of each of 40 strips. A line is fitted to each flank, from
# 15 % off the middle to 15 % off the edge, by least squares. Prints the left and the right angle and their mean, in degrees.
BEGIN { strip = half / 20; margin = 0.15 * half }
NR > 1 && $3 > 0 && $2 > -half && $2 < half {
    k = int(($2 + half) / strip)
    top = $3 + $6 / 2
    if (!(k in height) || top > height[k]) height[k] = top
}
function flank(sign,    k, x, n, sx, sy, sxx, sxy) {
    n = sx = sy = sxx = sxy = 0
    for (k in height) {
        x = sign * ((k + 0.5) * strip - half)
        if (x < margin || x > half - margin) continue
        n++; sx += x; sy += height[k]; sxx += x * x; sxy += x * height[k]
    }
    return n < 3 ? 0 : atan2(-(n * sxy - sx * sy) / (n * sxx - sx * sx), 1) * 180 / 3.14159265358979
}
END { left = flank(-1); right = flank(1); printf "%.1f %.1f %.1f\n", left, right, (left + right) / 2 }
