/* SPDX-License-Identifier: MIT
 *
 * pictures.h - a picture from its first line to its file.
 */
#ifndef NARC_STUDY_PICTURES_H
#define NARC_STUDY_PICTURES_H

#include "canvas.h"

void open_picture(canvas *page, const char *path, double width, double height);

/* Writes it, with fewer shades. */
void finish_picture(canvas *page);

#endif
