/* mpm.c - the implementation of all headers in one file, for whoever prefers to compile once: the other
   files then include the headers they need and define nothing. SPDX-License-Identifier: MIT

     cc -std=c99 -O3 -c mpm.c          as C++: c++ -x c++ -std=c++11 -O3 -c mpm.c
     cc -std=c99 -O3 program.c mpm.o -lm

   MPM_FLOAT, where it is wanted, belongs on both command lines. Every header of the library is listed here
   (Test: 72_vendor); mpm.h comes first, the others stand in any order. */
#define MPM_IMPLEMENTATION
#include "mpm.h"
#include "mpm_bond.h"
#include "mpm_draw.h"
#include "mpm_hdf5.h"
#include "mpm_io.h"
#include "mpm_measure.h"
#include "mpm_ptw.h"
#include "mpm_spray.h"
#include "mpm_surface.h"
