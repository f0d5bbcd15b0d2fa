/* Area and conductance of a pad's contact by its force, as thermal/contact/footprint.py for what is flat. */

#include <math.h>

#include "heat.h"

#define LEVEL 1e-7   /* rad, below which there is no angle */
#define THIN 1e-12   /* m: a patch that is narrower is none */
#define STEPS 4      /* Newton's */
#define HALF_TURN 3.141592653589793

static double overlap(double reach, double offset, double half) {
  return greater(lesser(reach, half - offset) + lesser(reach, half + offset), 0);
}

void heat_contact(const Law* law, double force, const double place[3], double* area, double* share) {
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
}

/* Both as thermal/contact/patch_place.py. */
static bool is_narrow(double length, double width) { return length > 0 && length < width * (1 - 1e-9); }

static double patch_offset(double offset, double length, double width) {
  if (!is_narrow(length, width)) return 1;
  double near = sin(HALF_TURN * length / (2 * width)), aside = cos(HALF_TURN * lesser(fabs(offset), (width - length) / 2) / width);
  return lesser(log(aside) / log(near), 1);
}

double heat_offset_of(double share, double length, double width) {
  if (!is_narrow(length, width)) return 0;
  double near = sin(HALF_TURN * length / (2 * width));
  return lesser(acos(exp(lesser(greater(share, 0), 1) * log(near))) * width / HALF_TURN, (width - length) / 2);
}

static double patch_ends(double middle, double pad, double length, double side, double width) {
  if (!is_narrow(length, width)) return 1;
  double whole = greater(side / 2 - fabs(pad), lesser(side, width) / 2), near = greater(side / 2 - fabs(middle), length / 2);
  return lesser(greater(log(whole / near) / log(width / length), 0), 1);
}

double heat_flat_patch(const Law* law, double area, const double place[3], double width, double shares[4]) {
  double length = 0;
  for (int side = 0; side < 4; side++) shares[side] = 0;
  if (law->size[0] == 0 || area >= width * width * (1 - 1e-9)) return sqrt(area);
  for (int side = 0; side < 2; side++) {
    double pad = place[(int)law->across[side]], size = law->size[side];
    double low = greater(-law->half_face, -pad - size / 2), high = lesser(law->half_face, size / 2 - pad);
    length = high - low;
    shares[side] = patch_offset((low + high) / 2, length, width);
    shares[2 + side] = patch_ends(pad + (low + high) / 2, pad, length, size, width);
  }
  return length;
}

/* The place of a table before `at` m, and the share of the way to the next. */
static int between(const double* places, double at, double* share) {
  int k = 0;
  while (k < PLACES - 2 && at >= places[k + 1]) k++;
  *share = lesser((at - places[k]) / (places[k + 1] - places[k]), 1);
  return k;
}

static double even(const double* value, double u, double v) {
  const double* next = value + VALUES * PLACES;
  double one = value[0] + v * (value[VALUES] - value[0]), other = next[0] + v * (next[VALUES] - next[0]);
  return one + u * (other - one);
}

/* What a contact conducts between two forces of a table; step: of that power of theirs which counts, a logarithm. */
static double by_force(double low, double high, double w, double step) {
  if (low > 0 && high > 0) {
    double rise = log(high / low);
    if (rise < step) return low * exp(w * rise);
  }
  return greater(low + (high - low) * (exp(w * step) - 1) / (exp(step) - 1), 0);
}

/* W/K, and the patch's area m2, length m and shares, by a table, as thermal/contact/curved_table.py. */
double heat_curved(const double* table, const double grid[3], double force, double aside, double along, double* area,
                   double* length, double shares[4]) {
  double u, v, mean[VALUES];
  int i = between(table, fabs(aside), &u), j = between(table + PLACES, fabs(along), &v);
  double at = (log(force) - grid[0]) / grid[1];
  int k = (int)lesser(greater(at, 0), FORCES - 2);
  double w = lesser(at - k, 1);
  const double* low = table + 2 * PLACES + VALUES * ((k * PLACES + i) * PLACES + j);
  const double* high = low + VALUES * PLACES * PLACES;
  double contact = by_force(even(low + OF_CONTACT, u, v), even(high + OF_CONTACT, u, v), w, grid[1] * table[CURVED - 1]);
  w = greater(w, 0);
  for (int n = 1; n < VALUES; n++) {
    mean[n] = even(low + n, u, v);
    mean[n] += w * (even(high + n, u, v) - mean[n]);
  }
  double conducts = contact + mean[OF_GAS];
  if (conducts <= grid[2]) return 0;
  double part = contact / conducts;
  *area = mean[WIDE_PATCH] + part * (mean[PATCH] - mean[WIDE_PATCH]);
  double broad = mean[PATCH_LENGTH] > THIN ? mean[PATCH] / mean[PATCH_LENGTH] : 0;
  double broader = mean[WIDE_LENGTH] > THIN ? mean[WIDE_PATCH] / mean[WIDE_LENGTH] : 0;
  broad = broader + part * (broad - broader);
  *length = mean[WIDE_LENGTH] + part * (mean[PATCH_LENGTH] - mean[WIDE_LENGTH]);
  if (broad > THIN) *length = sqrt(*area * *length / broad);
  const double* first = table + SHARES + ENDS * ((k * PLACES + i) * PLACES + j);
  for (int n = 0; n < ENDS; n++) {
    shares[n] = 0;
    for (int corner = 0; corner < 8; corner++) {
      int a = corner & 1, b = corner >> 1 & 1, c = corner >> 2;
      double weight = (a ? w : 1 - w) * (b ? u : 1 - u) * (c ? v : 1 - v);
      shares[n] += weight * first[ENDS * ((a * PLACES + b) * PLACES + c) + n];
    }
  }
  return conducts;
}

/* The share of a rod's line that touches under a force N, and the force on it, as touch/contacts/tilt.py. */
double heat_tilted(const double* tilt, double first_force, double force, double slope, double middle, double* pressed) {
  double angle = fabs(slope) - tilt[TURN_BY] * force;
  *pressed = force;
  if (!(angle > LEVEL && tilt[RADIUS] > 0)) return 1;
  double cosine = 1 / sqrt(1 + slope * slope), half = tilt[HALF_ROD] * cosine;
  double along = slope > 0 ? middle : -middle;
  double start = greater(-along - half, -tilt[HALF_PAD]), end = lesser(half - along, tilt[HALF_PAD]);
  double first = greater(start, -tilt[HALF_FACE]), width = greater(lesser(end, tilt[HALF_FACE]) - first, 0);
  double steep = angle * sqrt(angle), reach = first - start, soft = tilt[SOFT] * steep, share;
  double gap = angle * greater(reach - pow(force / soft, 0.4), 0), held = greater(force - soft * pow(reach, 2.5), 0);
  if (tilt[FIRM] > 0) {
    double firm = tilt[FIRM] * steep, length = pow(held / firm, 0.4);
    for (int i = 0; i < STEPS; i++) {
      double load = firm * pow(length, 2.5) + soft * (pow(reach + length, 2.5) - pow(length, 2.5));
      double rate = 2.5 * (firm * pow(length, 1.5) + soft * (pow(reach + length, 1.5) - pow(length, 1.5)));
      length = held > 0 ? greater(length - (load - force) / rate, 0) : 0;
    }
    share = lesser(length / greater(width, THIN), 1);
    held = lesser(firm * pow(length, 2.5), held);
  } else {
    double near = sqrt(1 + gap / tilt[APART]), far = sqrt(1 + (gap + angle * width) / tilt[APART]);
    double wide = tilt[HALF_FACE] / sqrt(2 * tilt[RADIUS] * tilt[APART]);
    share = lesser((atan(wide / near) + atan(wide / far)) / atan(wide) / (near + far), 1);
  }
  if (!(width > 0)) share = 0;
  *pressed = greater(held, lesser(force, first_force * share));
  return share;
}

/* A series whose even and odd terms need not wait for each other. */
static double separation(const Numbers* numbers, double log_share) {
  /* range: slope and offset of the series' variable, and the logarithms of the least and most shares */
  const double *range = numbers->separation_range, *term = numbers->separation;
  double y = sqrt(-lesser(greater(log_share, range[2]), range[3]));
  double z = y * range[0] - range[1], even = 0, odd = 0;
  for (int i = SERIES - 1; i > 0; i -= 2) {
    even = even * (z * z) + term[i];
    odd = odd * (z * z) + term[i - 1];
  }
  return (even * z + odd) * z + term[0];
}

double heat_conductance(const Law* law, const Numbers* numbers, double pressure) {
  double log_pressure = log(pressure), share = law->elastic_share, separated = 0;
  if (share < 1) separated += (1 - share) * separation(numbers, log_pressure + log(2) - law->log_hardness);
  if (share > 0) separated += share * separation(numbers, log_pressure + log(4) - law->log_elastic_hardness);
  double solid = exp(lesser(law->spot_scale + law->spot_power * log_pressure, law->spot_most));
  double gap = law->roughness * separated + law->jump;
  if (law->flatness > 0) return solid + law->gas / law->flatness * log1p(law->flatness / gap);
  return solid + law->gas / gap;
}
