/* hostile.h - what headers of others leave behind, before ours: words they take as macros. A use of one of them is
   an error here, whatever the real macro would have made of it. SPDX-License-Identifier: MIT */
#include <errno.h>
#include <float.h>
#include <limits.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#ifdef _WIN32
#include <direct.h>
#include <fcntl.h>
#include <io.h>
#include <process.h>
#else
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>
#endif

/* <windows.h> and those it brings */
#undef near
#undef far
#undef small
#undef hyper
#undef interface
#undef pascal
#undef cdecl
#undef min
#undef max
#define near ?
#define far ?
#define small ?
#define hyper ?
#define huge ?
#define byte ?
#define interface ?
#define pascal ?
#define cdecl ?
#define min(a, b) ?
#define max(a, b) ?
#define IN ?
#define OUT ?
#define OPTIONAL ?
#define VOID ?
#define CONST ?
#define THIS ?
#define STRICT ?
#define ERROR ?
#define DELETE ?
#define ABSOLUTE ?
#define RELATIVE ?
#define TRANSPARENT ?
#define OPAQUE ?
#define DIFFERENCE ?
#define PASSTHROUGH ?
#define NO_ERROR ?
#define OPEN ?
#define EXTERNAL ?
#define INTERFACE ?
#define rad1 ?
#define rad2 ?
#define grp1 ?
#define chx1 ?
#define psh1 ?
#define stc1 ?
#define edt1 ?
#define lst1 ?
#define cmb1 ?
#define scr1 ?
#define frm1 ?
#define ctlFirst ?
#define ctlLast ?
#define FAR ?
#define NEAR ?
#define TRUE ?
#define FALSE ?

/* <complex.h>, <stdbool.h>, <iso646.h>, <sys/sysmacros.h>, <sys/param.h>, compilers and systems */
#undef I
#undef complex
#undef imaginary
#undef major
#undef minor
#undef MIN
#undef MAX
#undef linux
#undef unix
#undef i386
#define I ?
#define complex ?
#define imaginary ?
#define major ?
#define minor ?
#define makedev ?
#define MIN ?
#define MAX ?
#define roundup ?
#define howmany ?
#define powerof2 ?
#define linux ?
#define unix ?
#define i386 ?
#define sun ?
#define mips ?
#define arm ?
#define vax ?
#define vector ?
#define pixel ?
#define OVERFLOW ?
#define UNDERFLOW ?
#define DOMAIN ?
#define SING ?
#define PLOSS ?
#define TLOSS ?
#ifndef __cplusplus
#define bool ?
#define and ?
#define or ?
#define not ?
#define xor ?
#define compl ?
#define bitand ?
#define bitor ?
#endif

/* X11, curses, Arduino, debuggers; registers. Of single letters only <complex.h>'s I
   is taken by others: N, G and D are the books'. */
#define None ?
#define Status ?
#define Bool ?
#define True ?
#define False ?
#define Success ?
#define Always ?
#define Unsorted ?
#define Above ?
#define Below ?
#define CurrentTime ?
#define PI ?
#define TWO_PI ?
#define HIGH ?
#define LOW ?
#define INPUT ?
#define OUTPUT ?
#define constrain ?
#define radians ?
#define degrees ?
#define sq ?
#define bit ?
#define swap ?
#define likely ?
#define unlikely ?
#define check ?
#define verify ?
#define require ?
#define assert ?
#define nil ?
#define box(w, v, h) ?
#define clear() ?
#define move(y, x) ?
#define erase() ?
#define border(a) ?
#define timeout(d) ?
#define scroll(w) ?
#define echo() ?
#define filter() ?
#define B1 ?
#define ES ?
#define DS ?
#define SS ?
#define CS ?
#define FS ?
#define GS ?
#define _B ?
