# SPDX-License-Identifier: MIT
# The sand grains as points: Rscript grains.R FILE FOLDER, with sand.rda of the package shapes, writes river-01.csv,
# river-02.csv ... and sea-01.csv ... to the folder.
arguments <- commandArgs(trailingOnly = TRUE)
load(arguments[1]) # `sand`: 50 points, x and y, of each grain, and its group
for (group in levels(sand$group)) {
    members <- which(sand$group == group)
    for (k in seq_along(members)) {
        points <- sand$x[, , members[k]]
        file <- file.path(arguments[2], sprintf("%s-%02d.csv", group, k))
        writeLines(c("x,y", sprintf("%.17g,%.17g", points[, 1], points[, 2])), file)
    }
}
