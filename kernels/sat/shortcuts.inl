/* SPDX-License-Identifier: MIT
 *
 * shortcuts.inl - are pairs settled before they reach the deciding formula? Without shortcuts every pair goes to it:
 * the tests compare the two, bit for bit.
 */
#ifndef NARC_SAT_SHORTCUTS_INL
#define NARC_SAT_SHORTCUTS_INL

#ifndef NARC_SHORTCUTS
#define NARC_SHORTCUTS 1
#endif

#endif
