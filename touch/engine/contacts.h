/* What reads MuJoCo's data. */

#ifndef THERMOGRASP_CONTACTS_H
#define THERMOGRASP_CONTACTS_H

#include <mujoco/mujoco.h>

#include "heat.h"

void heat_read(const Numbers* numbers, const Work* work, const mjModel* m, const mjData* d, double* touches);

#endif
