/* spray_state.h - what tests of sprays share: states, compared and copied. SPDX-License-Identifier: MIT */
#ifndef SPRAY_STATE_H
#define SPRAY_STATE_H

#include "mpm_spray.h"
#include "check.h"

#include <string.h>

/* An action that has to succeed. */
static inline void done(const char *what, mpm_status status) { CHECK_EQUAL(what, status, MPM_OK); }

/* Whether two sprays are in the same state, bit by bit. */
static inline int same_state(mpm_spray *a, mpm_spray *b)
{
    mpm_blob of_a[MPM_SPRAY_BLOBS], of_b[MPM_SPRAY_BLOBS];
    int n = mpm_spray_blobs(a, of_a), same = mpm_spray_blobs(b, of_b) == n, k;
    for (k = 0; k < n && same; k++)
        same = of_a[k].bytes == of_b[k].bytes && !memcmp(of_a[k].data, of_b[k].data, of_a[k].bytes);
    return same;
}

/* Puts the state of one spray into another, as a checkpoint would: unchecked where there is room for it. */
static inline mpm_status copy_state(mpm_spray *from, mpm_spray *to)
{
    mpm_blob source[MPM_SPRAY_BLOBS], target[MPM_SPRAY_BLOBS];
    int n = mpm_spray_blobs(from, source), k;
    if (mpm_spray_blobs(to, target) != n) return MPM_ERR_FILE;
    for (k = 0; k < n; k++)
        if (source[k].bytes > (target[k].room ? target[k].room : target[k].bytes)) return MPM_ERR_FILE;
    for (k = 0; k < n; k++) {
        memcpy(target[k].data, source[k].data, source[k].bytes);
        target[k].bytes = source[k].bytes;
    }
    return mpm_spray_restored(to, target);
}

#endif
