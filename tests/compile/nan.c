/* nan - what is not a number is noticed by every header that promises it, at the optimisation this is compiled with.
   SPDX-License-Identifier: MIT */
#define MPM_IMPLEMENTATION
#include "mpm_io.h"
#include "mpm_spray.h"
#include "scene.h"

#include <stdlib.h>
#include <string.h>

/* The step that notices a bad value in one of the points' columns, or -1. */
static int noticed_in(int column, mpm_real bad)
{
    const mpm_units u = mpm_units_um_us_ng();
    mpm_material m = scene_metal(0, u);
    mpm_desc d = scene_grid(1, 10, 10, 10, 0, 0, 0);
    mpm_body_desc ball = scene_body(&m, mpm_sphere(5, 5, 5, 2), 0.5, 0);
    int k, status = MPM_OK;
    mpm_world w;
    if (mpm_init(&w, &d, NULL, 0) != MPM_OK || mpm_body_add(&w, &ball) != MPM_OK) return -1;
    (column == 0 ? w.points.x[0] : column == 1 ? w.points.v[0] : w.points.temperature)[17] = bad;
    for (k = 0; k < 4 && status >= 0; k++) status = mpm_step(&w, MPM_R(1e-5));
    mpm_free(&w);
    return status == MPM_ERR_NAN ? k : -1;
}

int main(void)
{
    const mpm_real bad = (mpm_real)strtod("nan", NULL), endless = (mpm_real)strtod("inf", NULL);
    mpm_units u = mpm_units_um_us_ng();
    mpm_material m = scene_metal(0, u);
    mpm_desc d = scene_grid(1, 10, 10, 10, 0, 0, 0);
    mpm_spray_desc s = mpm_spray_desc_default();
    char text[2][64];
    int k, wrong = 0;
    d.contact.friction = bad;
    m.young = bad;
    s.alpha = bad;
    wrong += mpm_desc_check(&d, NULL) != MPM_ERR_NAN;
    wrong += mpm_material_check(&m, NULL) != MPM_ERR_NAN;
    wrong += mpm_spray_check(&s, NULL) != MPM_ERR_NAN;
    s.alpha = endless; /* means: all stick */
    wrong += mpm_spray_check(&s, NULL) != MPM_OK;
    mpm_io_number_text(text[0], sizeof text[0], (double)bad);
    mpm_io_number_text(text[1], sizeof text[1], (double)endless);
    wrong += strcmp(text[0], "nan") != 0 || strcmp(text[1], "inf") != 0;
    for (k = 0; k < 3; k++) wrong += noticed_in(k, bad) < 0;
    printf("%d unnoticed\n", wrong);
    return wrong;
}
