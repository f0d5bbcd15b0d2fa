/* Contact of a pad that is round itself, as touch/contacts/round_pads.py, and of one that leans, as touch/contacts/tilt.py. */

#include <math.h>

#include "heat.h"

#define LEAST 1e-7 /* of the larger curvature: what is straighter counts as that */
#define ALIKE 1e-9 /* of the mean curvature, by which the two differ at most where it is round */
#define NEWTON_STEPS 8
#define ALIGNED 0.05 /* m per m, up to which it counts as level */
#define LEANS 1e-7 /* m per m, below which a line lies level */
#define LEANING_STEPS 20
#define EVENLY (5.0 / 6) /* of a line, the square of the mean pressure over the mean of its square */
#define SHORT 1e-9    /* m, that a line which does not reach the other counts to touch */
#define SLIGHT 1e-4   /* rad: a smaller arc is its tangent */
#define SPOT 2.0 /* of through_soft */
#define EDGE 0.7
/* Gauss's four places between 0 and 1, and their weights */
#define WEDGE_NODES 0.06943184420297371, 0.33000947820757187, 0.6699905217924281, 0.9305681557970262
#define WEDGE_WEIGHTS 0.17392742256872679, 0.3260725774312732, 0.3260725774312732, 0.17392742256872679
#define NEARLY 0.999 /* of a line's depth at one end to that at the other, from which on it is the same */

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

/* How evenly a line presses whose depth falls evenly to this share of what it is at its lower end. */
static double along_line(double ratio) {
  if (ratio > NEARLY) return EVENLY;
  double middle = (1 - pow(ratio, 2.5)) / 2.5;
  return EVENLY * middle * middle * 1.5 * 3.5 / ((1 - pow(ratio, 1.5)) * (1 - pow(ratio, 3.5)));
}

static double cap_squared(double s) {
  double square = s * s;
  return (s * sqrt(1 - square) * (33 + square * (8 * square - 26)) + 15 * asin(s)) / 48;
}

static double square_mean(double x, double y) {
  double first = x * x, second = y * y;
  return 1 - 2.0 / 3 * (first + second) + (first * first + second * second) / 5 + 2.0 / 9 * first * second;
}

/* Of such a quarter, the integral of (1 - r^2)^2 over it. */
static double squared(double x, double y) {
  if (x * x + y * y <= 1) return x * y * square_mean(x, y);
  double root = sqrt(1 - y * y);
  return root * y * square_mean(root, y) + 8.0 / 15 * (cap_squared(x) - cap_squared(root));
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

/* Share of an interval of half width reach that is on two faces of these half widths, of the most that can be; its middle is
`at` from the one face's and other_at from the other's. */
static double kept(double at, double other_at, double reach, double half, double other_half) {
  double after = lesser(lesser(half - at, reach), other_half - other_at);
  double before = lesser(lesser(half + at, reach), other_half + other_at);
  return lesser(greater(after + before, 0) / (2 * lesser(lesser(reach, half), other_half)), 1);
}

/* What strips bear whose depth grows from 0, integrated over it and over the stiffness; their widths likewise. */
static double strips(double depth, double curvature, double reach, double* area) {
  double wide = sqrt(2 / curvature), shallow = lesser(depth, curvature * reach * reach / 2);
  double root = sqrt(shallow), beyond = depth - shallow, first = 4.0 / 3 * wide * shallow * root;
  *area = first + 2 * reach * beyond;
  return 8.0 / 15 * wide * shallow * shallow * root + beyond * (first + reach * beyond);
}

/* Area and force on the face of a straight pad that leans, and the depth at the face's lower end; 0 where it is off. */
static double leaning(const double* bend, double force, double angle, double curvature, double first_share, const double ends[2],
                      const double firm_half[2], const double face_half[2], double depth, double* area, double* lower) {
  double firm_reach = firm_half[0], width = firm_half[1], face_reach = face_half[0], face_width = face_half[1];
  double soft_reach = lesser(first_share * bend[8] + (1 - first_share) * bend[9], ends[0]), load = force * angle;
  double soft_width = greater(lesser((1 - first_share) * bend[8] + first_share * bend[9], ends[1]), width);
  double near = (soft_width - face_width) * angle, far = (soft_width + face_width) * angle, end = 2 * soft_width * angle;
  double firm = bend[2], soft = bend[7], most_soft = soft != firm ? far : INFINITY, wide, narrow;
  depth += angle * (soft_width + width);
  double low = 0, high = depth;
  for (int i = 0; i < LEANING_STEPS; i++) {
    double sunk = lesser(depth, most_soft), held = 0, rate = 0;
    /* springs: stiffness, reach, and how deep they are where they begin and end */
    double springs[3][4] = {{soft, soft_reach, sunk, sunk - near},
                            {firm, firm_reach, depth - near, depth - far},
                            {soft, soft_reach, sunk - far, sunk - end}};
    for (int n = 0; n < 3; n++) {
      double one = strips(greater(springs[n][2], 0), curvature, springs[n][1], &wide);
      double other = strips(greater(springs[n][3], 0), curvature, springs[n][1], &narrow);
      held += springs[n][0] * (one - other);
      if (springs[n][0] == firm || depth < most_soft) rate += springs[n][0] * (wide - narrow);
    }
    if (held < load) low = depth;
    else high = depth;
    double before = depth;
    depth -= (held - load) / rate;
    if (!(low <= depth && depth <= high)) depth = (low + high) / 2;
    if (fabs(depth - before) < 1e-14 * depth) break;
  }
  *area = 0;
  *lower = depth - near;
  if (*lower <= 0) return 0;
  double most = strips(*lower, curvature, face_reach, &wide);
  double least = strips(greater(depth - far, 0), curvature, face_reach, &narrow);
  *area = (wide - narrow) / angle;
  return bend[2] * (most - least) / angle;
}

double heat_round_contact(const double* bend, const double* curve, const double sides[SIDES], double force, double y, double z,
                          double* area, double* share, double* longer, double* even, Wedge* wedge) {
  double first = bend[0] + curve[0] * sides[0] * sides[0] + curve[1] * sides[2] * sides[2];
  double both = curve[0] * sides[0] * sides[1] + curve[1] * sides[2] * sides[3];
  double second = bend[1] + curve[0] * sides[1] * sides[1] + curve[1] * sides[3] * sides[3];
  double middle = (first + second) / 2, spread = hypot((first - second) / 2, both);
  double most = middle + spread, least = greater(middle - spread, LEAST * (middle + spread));
  double first_share = lesser(greater((1 + (first - second) / 2 / spread) / 2, 0), 1);
  if (!(spread > ALIKE * middle)) { /* any direction is as good: that of the sides of the one that is flat */
    bool flat = bend[0] + bend[1] == 0;
    first_share = flat ? 1 : sides[0] * sides[0] / (sides[0] * sides[0] + sides[1] * sides[1]);
    both = flat ? 0 : sides[0] * sides[1];
  }
  double along = sqrt(first_share), aside = copysign(sqrt(1 - first_share), both), part = along * sides[0] + aside * sides[1];
  double other = lesser(part * part, 1);
  double other_reach = other * curve[2] + (1 - other) * curve[3], other_width = (1 - other) * curve[2] + other * curve[3];
  double reach = lesser(first_share * bend[3] + (1 - first_share) * bend[4], other_reach);
  double width = lesser((1 - first_share) * bend[3] + first_share * bend[4], other_width);
  double face_reach = lesser(first_share * bend[5] + (1 - first_share) * bend[6], reach);
  double face_width = lesser((1 - first_share) * bend[5] + first_share * bend[6], width);
  double stiffness = bend[2] / (1 + bend[2] * curve[4]);
  double depth = depth_of(force / stiffness, most, least, reach, width), load;
  double over = along * y + aside * z, beyond = along * z - aside * y;
  /* a round body is no wider than its radius */
  double bulk = lesser(other_reach, 1 / greater(other * curve[0] + (1 - other) * curve[1], 1 / WIDE));
  double bulk_width = lesser(other_width, 1 / greater((1 - other) * curve[0] + other * curve[1], 1 / WIDE));
  wedge->left = greater(-face_reach - over, -bulk);
  wedge->right = lesser(face_reach - over, bulk);
  wedge->curvature = most;
  double leans = fabs(along * sides[5] - aside * sides[4]) - ALIGNED;
  if (leans > LEANS && middle - spread < least) {
    double ends[2] = {other_reach, other_width}, lower;
    double firm_half[2] = {reach, width}, face_half[2] = {face_reach, face_width};
    *share = leaning(bend, force, leans, most, first_share, ends, firm_half, face_half, depth, area, &lower);
    *longer = 1;
    *even = 1;
    wedge->depth = lower;
    wedge->slope = leans;
    wedge->bend = wedge->lower = 0;
    wedge->upper = 2 * face_width;
    if (!(*area > 0)) return 0;
    double across = sqrt(2 * lower / most);
    *longer = lesser(lower / leans, 2 * face_width) / (2 * lesser(across, face_reach));
    *longer = greater(*longer, 1 / *longer);
    *even = along_line(greater(1 - 2 * face_width * leans / lower, 0));
    return kept(over, 0, across, face_reach, WIDE);
  }
  double a = sqrt(2 * depth / most), b = sqrt(2 * depth / least);
  double far_over = along * sides[6] + aside * sides[7], far_beyond = along * sides[7] - aside * sides[6];
  if (curve[4] > 0) { /* another fingertip: what is on a face depends on where each pad's own middle is */
    face_reach = lesser(first_share * bend[5] + (1 - first_share) * bend[6], first_share * bend[3] + (1 - first_share) * bend[4]);
    face_width = lesser((1 - first_share) * bend[5] + first_share * bend[6], (1 - first_share) * bend[3] + first_share * bend[4]);
    other_reach = lesser(other * curve[5] + (1 - other) * curve[6], other_reach);
    other_width = lesser((1 - other) * curve[5] + other * curve[6], other_width);
    bulk = lesser(other_reach, bulk);
    bulk_width = lesser(other_width, bulk_width);
  } else {
    other_reach = other_width = WIDE;
  }
  double on_faces = kept(over, far_over, a, face_reach, other_reach);
  on_faces *= kept(beyond, far_beyond, b, face_width, other_width);
  wedge->depth = depth;
  wedge->slope = 0;
  wedge->bend = least;
  wedge->left = greater(-face_reach - over, -bulk - far_over);
  wedge->right = greater(lesser(face_reach - over, bulk - far_over), wedge->left);
  wedge->lower = greater(-face_width - beyond, -bulk_width - far_beyond);
  wedge->upper = greater(lesser(face_width - beyond, bulk_width - far_beyond), wedge->lower);
  face_reach = lesser(face_reach, other_reach);
  face_width = lesser(face_width, other_width);
  double x = lesser(face_reach / a, 1), breadth = lesser(face_width / b, 1), quarter = clipped(x, breadth, &load);
  *area = 4 * a * b * quarter;
  *even = load * load / (quarter * squared(x, breadth));
  *share = 4 * stiffness * depth * a * b * load;
  *longer = lesser(b, face_width) / lesser(a, face_reach);
  *longer = greater(*longer, 1 / *longer);
  return on_faces;
}

/* m per m of y, as _across_wedge of thermal/contact/gas_beside.py. */
static double across_wedge(const Wedge* wedge, double gap, double y) {
  double deep = wedge->depth - wedge->slope * y - wedge->bend * y * y / 2, half = wedge->curvature / 2;
  double start = sqrt(greater(deep, 0) / half), space = gap - deep, root = sqrt(fabs(space * half)), total = 0;
  double sides[2][2] = {{wedge->left, wedge->right}, {-wedge->right, -wedge->left}};
  for (int n = 0; n < 2; n++) {
    double near = greater(sides[n][0], start), far = sides[n][1];
    if (far <= near) continue;
    double turn = root * (far - near) / (space + half * far * near);
    if (turn < SLIGHT) total += (far - near) / (space + half * far * near);
    else total += (space > 0 ? atan(turn) : atanh(turn)) / root;
  }
  return total;
}

static double wedge_gas(const Wedge* wedge, double gap) {
  static const double nodes[] = {WEDGE_NODES}, weights[] = {WEDGE_WEIGHTS};
  double end = wedge->slope > 0 ? greater(wedge->depth / wedge->slope, SHORT) : sqrt(2 * wedge->depth / wedge->bend), total = 0;
  for (int way = 1; way > -2; way -= 2) {
    double near = greater(way > 0 ? wedge->lower : -wedge->upper, 0), far = greater(way > 0 ? wedge->upper : -wedge->lower, near);
    double turn = asin(lesser(near / end, 1)), turns = asin(lesser(far / end, 1)) - turn;
    double root = sqrt(greater(near - end, 0)), roots = sqrt(greater(far - end, root * root)) - root;
    for (int k = 0; k < (int)(sizeof nodes / sizeof *nodes); k++) {
      if (turns > 0) { /* beside what touches */
        double at = turn + nodes[k] * turns;
        total += weights[k] * turns * end * cos(at) * across_wedge(wedge, gap, way * end * sin(at));
      }
      if (roots > 0) { /* beyond its end */
        double at = root + nodes[k] * roots;
        total += weights[k] * roots * 2 * at * across_wedge(wedge, gap, way * (end + at * at));
      }
    }
  }
  return total;
}

/* Of thermal/contact/footprint.py: W/K of a contact between bodies that give way, with what its heat meets more than it would
over the whole. */
static double through_soft(double conducts, double around, double area, double length, double face, double whole, const Law* below) {
  if (!(area > 0 && area < whole)) return conducts;
  double spot = lesser(greater(SPOT * (1 - length / face), 0), 1), radius = sqrt(area / pi), wide = sqrt(whole / pi);
  double spreads = below->series / 4 * (1 / radius - 1 / wide), rim = pi * radius, outer = pi * wide;
  if (spot < 1) {
    double along = lesser(length, face), strip = -below->series / (pi * along) * log(sin(pi / 2 * area / whole));
    spreads = strip + spot * (spreads - strip);
    rim = along + spot * (rim - along);
    outer = along + spot * (outer - along);
  }
  double straight = below->deep * (1 / area - 1 / whole), edge = EDGE * below->thick;
  double more = below->sheet * (1 / (area + edge * rim) - 1 / (whole + edge * outer));
  if (spreads > 0) more += spreads * straight / sqrt(spreads * spreads + straight * straight);
  double same = lesser(around * area / (whole - area), conducts);
  return same + (conducts - same) / (1 + (conducts - same) * more);
}

void heat_beside_round(const Law* law, const Wedge* wedge, double* conducts, double* area, double* length) {
  if (!(law->mean_gap > 0)) return;
  double around = law->gas * wedge_gas(wedge, law->mean_gap);
  if (!(around > 0)) return;
  double resistance = law->straight + law->sheet, face = 2 * law->half_face;
  double less = law->gas * wedge_gas(wedge, law->mean_gap + law->gas * resistance);
  double rest = greater((wedge->right - wedge->left) * (wedge->upper - wedge->lower) - *area, 0);
  double spread = around > less ? lesser(around * less * resistance / (around - less), rest) : rest;
  double whole = *area + spread, longer = 1;
  if (*area > 0) {
    longer = greater(*length * *length / *area, 1);
    *conducts = through_soft(*conducts, around, *area, *length, face, whole, law);
  }
  *conducts += around;
  *area = whole;
  *length = greater(lesser(sqrt(whole * longer), face), whole / face);
}
