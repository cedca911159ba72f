/* append - adds frames to a file of HDF5 until it is killed: append FILE FRAME FRAMES, from number FRAME on. It prints
   the number of every frame that is in the file. SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "mpm_hdf5.h"

#include <stdio.h>
#include <stdlib.h>

#define POINTS 3000

int main(int argc, char **argv)
{
    static mpm_real x[3][POINTS], hot[POINTS];
    mpm_hdf5_field field = mpm_hdf5_scalar("temperature (K)", hot, 1);
    mpm_hdf5_desc d = mpm_hdf5_desc_default();
    mpm_fault fault;
    long frame, frames;
    int i, a;
    if (argc != 4) return 2;
    for (a = 0; a < 3; a++) d.x[a] = x[a];
    d.fields = &field;
    d.field_count = 1;
    d.gzip = 1;
    frames = strtol(argv[3], NULL, 10);
    for (frame = strtol(argv[2], NULL, 10); frame < frames; frame++) {
        d.count = (size_t)(POINTS - frame % 7);
        for (i = 0; i < POINTS; i++) {
            hot[i] = (mpm_real)(frame + i);
            for (a = 0; a < 3; a++) x[a][i] = (mpm_real)(i * (a + 1));
        }
        d.time = (double)frame;
        if (mpm_hdf5_frame(argv[1], frame, &d, &fault) < 0) {
            fprintf(stderr, "%s %lld\n", fault.field, (long long)fault.index);
            return 1;
        }
        printf("%ld\n", frame);
        fflush(stdout);
    }
    return 0;
}
