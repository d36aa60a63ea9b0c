/* SPDX-License-Identifier: MIT
 *
 * status.c - names of status codes.
 */
#include "narc_shapes.h"

const char *narc_status_name(narc_status status) {
    switch (status) {
    case NARC_OK:
        return "NARC_OK";
    case NARC_ERROR_ARGUMENT:
        return "NARC_ERROR_ARGUMENT";
    case NARC_ERROR_MEMORY:
        return "NARC_ERROR_MEMORY";
    case NARC_ERROR_INDEX:
        return "NARC_ERROR_INDEX";
    case NARC_ERROR_CAPACITY:
        return "NARC_ERROR_CAPACITY";
    case NARC_ERROR_COUNT:
        return "NARC_ERROR_COUNT";
    case NARC_ERROR_NOT_FINITE:
        return "NARC_ERROR_NOT_FINITE";
    case NARC_ERROR_SIZE:
        return "NARC_ERROR_SIZE";
    case NARC_ERROR_RADIUS:
        return "NARC_ERROR_RADIUS";
    case NARC_ERROR_SWEEP:
        return "NARC_ERROR_SWEEP";
    case NARC_ERROR_NOT_CLOSED:
        return "NARC_ERROR_NOT_CLOSED";
    case NARC_ERROR_NOT_CONVEX:
        return "NARC_ERROR_NOT_CONVEX";
    case NARC_ERROR_NOT_SIMPLE:
        return "NARC_ERROR_NOT_SIMPLE";
    case NARC_ERROR_NO_SOLUTION:
        return "NARC_ERROR_NO_SOLUTION";
    case NARC_ERROR_ISA_UNKNOWN:
        return "NARC_ERROR_ISA_UNKNOWN";
    case NARC_ERROR_ISA_UNSUPPORTED:
        return "NARC_ERROR_ISA_UNSUPPORTED";
    case NARC_ERROR_FORMAT:
        return "NARC_ERROR_FORMAT";
    case NARC_ERROR_CANCELLED:
        return "NARC_ERROR_CANCELLED";
    case NARC_ERROR_VERSION:
        return "NARC_ERROR_VERSION";
    case NARC_ERROR_IN_USE:
        return "NARC_ERROR_IN_USE";
    }
    return "unknown status";
}
