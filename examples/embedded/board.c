/* board.c - board.h on a Cortex-M4: vectors, start, output by semihosting, and how deep the stack was. With board.ld.
   The stack lies at the lowest addresses of the RAM, where nothing is below it: what overflows faults, and is told.
   SPDX-License-Identifier: MIT */
#include "board.h"

#include <stdint.h>

int main(void);
void board_start(void);
void board_fault(void);

/* Places that board.ld knows. */
extern uint32_t board_stack[], board_stack_end[], board_data[], board_data_end[], board_bss[], board_bss_end[];
extern const uint32_t board_data_load[];

static const uint32_t paint = 0x5aa5c33cu;

__attribute__((section(".vectors"), used)) static const struct {
    uint32_t *stack;
    void (*handler[15])(void);
} vectors = {board_stack_end, {board_start, board_fault, board_fault, board_fault, board_fault, board_fault}};

/* Asks whoever holds the debugger: qemu. */
static int ask(int what, const void *with)
{
    register int r0 __asm__("r0") = what;
    register const void *r1 __asm__("r1") = with;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

void board_put(const char *text) { ask(0x04, text); }

/* A number of bytes, in decimal. */
static void put_bytes(uint32_t n)
{
    char text[12], *at = text + 11;
    *at = 0;
    do *--at = (char)('0' + n % 10);
    while ((n /= 10) > 0);
    board_put(at);
}

/* How much of the stack has lost its paint. */
void board_end(void)
{
    const uint32_t *at = board_stack;
    while (at < board_stack_end && *at == paint) at++;
    board_put("# bytes of stack ");
    put_bytes((uint32_t)((const char *)board_stack_end - (const char *)at));
    board_put(" of ");
    put_bytes((uint32_t)((const char *)board_stack_end - (const char *)board_stack));
    board_put("\n");
}

static void leave(int status)
{
    const uint32_t why[2] = {0x20026, (uint32_t)status}; /* the application has ended */
    ask(0x20, why);
    for (;;) {}
}

/* Paints the stack below this function's frame, readies data and coprocessor, runs. */
void board_start(void)
{
    uint32_t *at = board_stack, *here;
    const uint32_t *from = board_data_load;
    __asm__ volatile("mov %0, sp" : "=r"(here));
    while (at < here) *at++ = paint;
    for (at = board_data; at < board_data_end;) *at++ = *from++;
    for (at = board_bss; at < board_bss_end;) *at++ = 0;
    *(volatile uint32_t *)0xe000ed88u |= 0xfu << 20; /* CPACR: floating point */
    __asm__ volatile("dsb\n isb" : : : "memory");
    leave(main());
}

void board_fault(void)
{
    __asm__ volatile("ldr r0, =board_stack_end\n mov sp, r0" : : : "r0", "memory"); /* there may be no stack left */
    board_put("# fault: a stack that is too small, or an address that is none\n");
    leave(2);
}
