/* board.h - what examples/embedded asks of the machine it runs on: board.c is a Cortex-M4, desktop.c the one at hand.
   SPDX-License-Identifier: MIT */
#ifndef BOARD_H
#define BOARD_H

void board_put(const char *text); /* the one hook for output */
void board_end(void);             /* says what the run took of the machine, if that is known */

#endif
