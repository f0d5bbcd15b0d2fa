/* Contact of a pad that is round itself, as touch/contacts/round_pads.py. */

#include <math.h>

#include "heat.h"

#define LEAST 1e-7 /* of the larger curvature: what is straighter counts as that */
#define NEWTON_STEPS 8
static const double pi = 3.14159265358979323846;

static double disc(double s) { return (s * sqrt(1 - s * s) + asin(s)) / 2; }

static double cap(double s) { return (s * (5 - 2 * s * s) * sqrt(1 - s * s) + 3 * asin(s)) / 8; }

/* Of a quarter of the unit disc in a rectangle: its area, and the integral of 1 - r^2 over it. */
static double clipped(double x, double y, double* load) {
  if (x * x + y * y <= 1) {
    *load = x * y * (1 - (x * x + y * y) / 3);
    return x * y;
  }
  double root = sqrt(1 - y * y);
  *load = y * root * (1 - y * y / 3 - root * root / 3) + 2.0 / 3 * (cap(x) - cap(root));
  return y * root + disc(x) - disc(root);
}

static double depth_of(double load, double most, double least, double reach, double width) {
  double depth = greater(sqrt(load * sqrt(most * least) / pi), load / (4 * reach * width));
  depth = greater(depth, pow(0.375 * load * sqrt(most / 2) / width, 2.0 / 3));
  depth = greater(depth, pow(0.375 * load * sqrt(least / 2) / reach, 2.0 / 3));
  for (int i = 0; i < NEWTON_STEPS; i++) {
    double a = sqrt(2 * depth / most), b = sqrt(2 * depth / least), held;
    double area = clipped(lesser(reach / a, 1), lesser(width / b, 1), &held);
    double change = (depth * held - load / (4 * a * b)) / area;
    depth -= change;
    if (fabs(change) < 1e-15 * depth) break;
  }
  return depth;
}

/* Share of an interval of half width reach round `at` that is within -half to half, of the most that can be. */
static double kept(double at, double reach, double half) {
  return lesser(greater(lesser(half, at + reach) - greater(-half, at - reach), 0) / (2 * lesser(reach, half)), 1);
}

double heat_round_contact(const double* bend, const double* curve, const double sides[4], double force, double y, double z,
                          double* area, double* share, double* longer) {
  double first = bend[0] + curve[0] * sides[0] * sides[0] + curve[1] * sides[2] * sides[2];
  double both = curve[0] * sides[0] * sides[1] + curve[1] * sides[2] * sides[3];
  double second = bend[1] + curve[0] * sides[1] * sides[1] + curve[1] * sides[3] * sides[3];
  double middle = (first + second) / 2, apart = hypot((first - second) / 2, both);
  double most = middle + apart, least = greater(middle - apart, LEAST * (middle + apart));
  double own = apart > 0 ? lesser(greater((1 + (first - second) / 2 / apart) / 2, 0), 1) : 1;
  double along = sqrt(own), aside = copysign(sqrt(1 - own), both), part = along * sides[0] + aside * sides[1];
  double other = lesser(part * part, 1);
  double reach = lesser(own * bend[3] + (1 - own) * bend[4], other * curve[2] + (1 - other) * curve[3]);
  double width = lesser((1 - own) * bend[3] + own * bend[4], (1 - other) * curve[2] + other * curve[3]);
  double face_reach = lesser(own * bend[5] + (1 - own) * bend[6], reach);
  double face_width = lesser((1 - own) * bend[5] + own * bend[6], width);
  double depth = depth_of(force / bend[2], most, least, reach, width), load;
  double a = sqrt(2 * depth / most), b = sqrt(2 * depth / least);
  *area = 4 * a * b * clipped(lesser(face_reach / a, 1), lesser(face_width / b, 1), &load);
  *share = 4 * bend[2] * depth * a * b * load;
  *longer = lesser(b, face_width) / lesser(a, face_reach);
  *longer = greater(*longer, 1 / *longer);
  return kept(along * y + aside * z, a, face_reach) * kept(along * z - aside * y, b, face_width);
}
