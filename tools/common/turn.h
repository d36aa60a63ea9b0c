/* SPDX-License-Identifier: MIT
 *
 * turn.h - a full turn in radians.
 */
#ifndef NARC_TOOL_TURN_H
#define NARC_TOOL_TURN_H

#define FULL_TURN 6.283185307179586476925

#endif
