/* Area and conductance of a pad's contact by its force, as thermal/contact/law.py. */

#include <math.h>

#include "heat.h"

#define NEWTON_STEPS 8
static const double pi = 3.14159265358979323846;

static double square_area(double u) {
  if (u <= 1) return pi * u;
  if (u >= 2) return 4;
  return pi * u - 4 * (u * acos(1 / sqrt(u)) - sqrt(u - 1));
}

static double square_load(double u) {
  if (u <= 1) return pi / 2 * u * u;
  if (u >= 2) return 4 * u - 8.0 / 3;
  double root = sqrt(u - 1), turned = acos(1 / sqrt(u));
  return pi / 2 * u * u - 2 * u * u * turned + 2 * root * u + 4.0 / 3 * root * root * root;
}

static double square_inverse(double load) {
  double narrow = sqrt(2 * load / pi);
  if (load <= pi / 2) return narrow;
  double u = fmax(narrow, (load + 8.0 / 3) / 4);
  for (int i = 0; i < NEWTON_STEPS; i++) {
    double change = (square_load(u) - load) / square_area(u);
    u -= change;
    if (fabs(change) < 1e-15 * u) break;
  }
  return u;
}

static double overlap(double reach, double offset, double half) {
  return fmax(fmin(reach, half - offset) + fmin(reach, half + offset), 0);
}

void heat_contact(const Law* law, double force, const double place[3], double* area, double* share) {
  if (law->shape == SHAPE_FLAT) {
    *area = law->area;
    *share = force * law->share;
    if (law->size[0] == 0) return;
    double on_pad = 1, on_face = 1;
    for (int side = 0; side < 2; side++) {
      double offset = fabs(place[(int)law->across[side]]), half = law->size[side] / 2;
      on_pad *= overlap(law->half_pad, offset, half);
      on_face *= overlap(law->half_face, offset, half);
    }
    *area = on_face;
    *share = on_pad > 0 ? force * (law->ratio * on_face / (on_pad + (law->ratio - 1) * on_face)) : 0;
    return;
  }
  double half = law->half_pad, half_face = law->half_face, stiffness = law->stiffness;
  if (law->shape == SHAPE_CYLINDER) {
    double load = force / (stiffness * law->pad_length), narrow = pow(0.75 * load, 1.0 / 3), square = narrow * narrow;
    if (narrow > half) square = (load / half + 2.0 / 3 * half * half) / 2;
    double across = fmin(sqrt(square), half_face);
    *area = law->face_length * 2 * across;
    *share = stiffness * *area * (square - across * across / 3);
    return;
  }
  double square = square_inverse(force / (stiffness * half * half * half * half)) * half * half;
  double u = square / (half_face * half_face);
  *area = half_face * half_face * square_area(u);
  *share = stiffness * half_face * half_face * half_face * half_face * square_load(u);
}

static double separation(const Numbers* numbers, double log_share) {
  const double* range = numbers->separation_range; /* low, high, and the logarithms of the least and most shares */
  double y = sqrt(-fmin(fmax(log_share, range[2]), range[3]));
  double z = (2 * y - range[0] - range[1]) / (range[1] - range[0]), total = 0;
  for (int i = SERIES - 1; i >= 0; i--) total = total * z + numbers->separation[i];
  return total;
}

double heat_conductance(const Law* law, const Numbers* numbers, double pressure) {
  double log_pressure = log(pressure), share = law->elastic_share, apart = 0;
  if (share < 1) apart += (1 - share) * separation(numbers, log_pressure + log(2) - law->log_hardness);
  if (share > 0) apart += share * separation(numbers, log_pressure + log(4) - law->log_elastic_hardness);
  double solid = exp(fmin(law->spot_scale + law->spot_power * log_pressure, law->spot_most));
  double gap = law->roughness * apart + law->jump;
  if (law->flatness > 0) return solid + law->gas / law->flatness * log1p(law->flatness / gap);
  return solid + law->gas / gap;
}
