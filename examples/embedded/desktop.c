/* desktop.c - board.h on a machine with an operating system. SPDX-License-Identifier: MIT */
#include "board.h"

#include <stdio.h>

void board_put(const char *text) { fputs(text, stdout); }
void board_end(void) {}
