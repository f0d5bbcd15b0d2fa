/* Contacts of a step as conductances, as touch/contacts/reader.py. */

#include <math.h>
#include <string.h>

#include "heat.h"

#define DEPTH 0.004  /* m off the pad's plane, up to which a contact is on it, beside half of what the two have sunk in */
#define RIM 0.0005   /* m beyond the pad's sides */
#define LOOKING 0.6  /* least cosine between the pad's normal and the contact's */
#define BY_RADIUS 0.7     /* the power of an ellipsoid's radius, by which contacts between its sides are even */
#define ONE_RADIUS 1e-6   /* relative difference, up to which two radii are one */

/* A pad in the world: its middle and its axes. */
typedef struct {
  bool known;
  double middle[3], axes[3][3];
} Pose;

/* Of pad f in this step, found when it is first asked for. */
static const Pose* pose(const Numbers* numbers, const Work* work, const mjData* d, int f, Pose* poses) {
  Pose* found = poses + f;
  if (found->known) return found;
  int body = work->body[numbers->geoms + f];
  const double *pad = numbers->pads + f * PAD, *turn = d->xmat + 9 * body;
  found->known = true;
  mju_mulMatVec3(found->middle, turn, pad);
  mju_addTo3(found->middle, d->xpos + 3 * body);
  for (int a = 0; a < 3; a++) mju_mulMatVec3(found->axes[a], turn, pad + AXES + 3 * a);
  return found;
}

/* Whether a contact is on a pad and looks at it, and where, m along its y and z. */
static bool lies(const double* pad, const Pose* at, const mjContact* contact, double sign, double* y, double* z) {
  double away[3], sunk = greater(-contact->dist, 0) / 2;
  subtract(contact->pos, at->middle, away);
  *y = dot(at->axes[1], away);
  *z = dot(at->axes[2], away);
  return sign * dot(at->axes[0], contact->frame) >= LOOKING && fabs(dot(at->axes[0], away)) <= DEPTH + sunk &&
         fabs(*y) <= pad[HALF] + RIM && fabs(*z) <= pad[HALF + 1] + RIM;
}

/* The view of a mesh that a pad belongs to, and where it is there, as touch/contacts/views.py. place: of the pad's middle. */
static int viewed(const double* views, int count, const double normal[3], const double p[3], double half, double at[2]) {
  int best = 0;
  double most = -2, q[3];
  for (int k = 0; k < count; k++) {
    const double* v = views + k * VIEW;
    double cosine = dot(v, normal);
    if (cosine > most) {
      most = cosine;
      best = k;
    }
  }
  const double* v = views + best * VIEW;
  double c[3], once[3], twice[3], across = dot(v + 3, normal), other = dot(v + 6, normal);
  mju_cross(c, normal, v);
  mju_cross(once, c, p);
  mju_cross(twice, c, once);
  for (int i = 0; i < 3; i++) q[i] = p[i] + once[i] + twice[i] / (1 + most);
  for (int j = 0; j < 2; j++)
    at[j] = greater(dot(v + 3 * (j + 1), q) + v[11 + 2 * j] * across + v[12 + 2 * j] * other - v[9 + j] + half, 0);
  return best;
}

/* The sides of an ellipsoid with the next smaller and the next larger radius, and the share of the second, as
touch/contacts/views.py. */
static double next_sides(const double* radii, int count, const double normal[3], int sides[2]) {
  double bent = 0;
  for (int k = 0; k < 3; k++) bent += normal[k] * normal[k] / radii[k];
  double radius = (1 + ONE_RADIUS) / bent;
  int below = -1, above = -1;
  for (int k = 0; k < count; k++)
    if (radii[k] > radius) {
      if (above < 0 || radii[k] < radii[above]) above = k;
    } else if (radii[k] > 0 && (below < 0 || radii[k] > radii[below])) {
      below = k;
    }
  sides[0] = below < 0 ? above : below;
  sides[1] = above < 0 ? below : above;
  if (below < 0 || above < 0) return 0;
  double least = radii[below];
  double share = (pow(1 / bent / least, BY_RADIUS) - 1) / (pow(radii[above] / least, BY_RADIUS) - 1);
  return lesser(greater(share, 0), 1);
}

/* The sides of an ellipsoid for a round pad that it touches y and z m from its middle, as touch/contacts/pad_contacts.py.
facing: its axes. */
static void on_ellipsoid(const double facing[3][3], const Pose* at, const double* radii, const double* curve, const double* bend,
                         double y, double z, double sides[SIDES]) {
  double lean_y = bend[0] * y, lean_z = bend[1] * z, upright = sqrt(greater(1 - lean_y * lean_y - lean_z * lean_z, 0));
  double square = 0, on_y = 0, on_z = 0, yy = 0, yz = 0, zz = 0;
  for (int i = 0; i < 3; i++) {
    double along = dot(facing[i], at->axes[0]), first = dot(facing[i], at->axes[1]), second = dot(facing[i], at->axes[2]);
    double normal = upright * along + lean_y * first + lean_z * second, turned = (along + normal) / (1 + upright);
    first -= lean_y * turned;
    second -= lean_z * turned;
    double half = radii[0] * radii[1] * radii[2] / radii[i];
    square += half * normal * normal;
    on_y += half * normal * first;
    on_z += half * normal * second;
    yy += half * first * first;
    yz += half * first * second;
    zz += half * second * second;
  }
  yy -= on_y * on_y / square;
  yz -= on_y * on_z / square;
  zz -= on_z * on_z / square;
  double high = sqrt(square);
  sides[0] = sqrt(high * zz / (yy * zz - yz * yz) / curve[0]);
  sides[1] = -sides[0] * yz / zz;
  sides[2] = 0;
  sides[3] = sqrt(high / zz / curve[1]);
}

/* Adds what presses one pad on one partner to the touch. pushed: force N and its moments. again: whether another geom of the
target has been counted in this step. before: steps of the sample before it. Returns whether one has now. */
static bool feel(const Numbers* numbers, const Work* work, const mjData* d, int f, int g, const double pushed[3],
                 Pose* poses, bool again, double before, double* touch) {
  const Pose* at = pose(numbers, work, d, f, poses);
  int geom = work->geom[g], body = work->body[g], axis = 0;
  double force = pushed[0], first = pushed[1] / force, second = pushed[2] / force;
  double away[3], place[3], looking[3], area = 0, share = 0, length = 0, conducts = 0, shares[4] = {0};
  const Pose* other = geom < 0 ? pose(numbers, work, d, g - numbers->geoms, poses) : NULL;
  double facing[3][3]; /* axes of what it meets */
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) facing[i][k] = other ? other->axes[i][k] : d->geom_xmat[9 * geom + 3 * k + i];
  subtract(at->middle, other ? other->middle : d->geom_xpos + 3 * geom, away);
  for (int i = 0; i < 3; i++) {
    place[i] = dot(other ? at->axes[i] : facing[i], away);
    looking[i] = dot(facing[i], at->axes[0]);
    if (!other && fabs(looking[i]) > fabs(looking[axis])) axis = i;
  }
  const Law* law = (const Law*)numbers->laws + (f * numbers->partners + g) * 3 + axis;
  const double *bend = numbers->bends + f * BEND, *curve = numbers->curves + (g * 3 + axis) * CURVES;
  bool bulging = bend[0] + bend[1] > 0 || (other && curve[0] + curve[1] > 0);
  int side = axis, views = other ? 0 : (int)numbers->viewed[g];
  double seen[2] = {0};
  if (views && !bulging)
    side = viewed(numbers->views + g * numbers->sides * VIEW, views, looking, place, law->half_face, seen);
  const double *radii = numbers->radii + g * numbers->sides, *tables = numbers->curved + (f * numbers->partners + g) * numbers->sides;
  int next[2] = {side, side};
  double part = 0;
  if (!other && !views && radii[0] > 0) {
    part = next_sides(radii, numbers->sides, looking, next);
    side = next[0];
  }
  int table = other ? -1 : (int)tables[side], larger = (int)tables[next[1]];
  if (table >= 0 && !bulging) {
    double lying = force, whole = 1;
    if (views) {
      first = seen[0];
      second = seen[1];
    } else if (law->shape == SHAPE_CYLINDER) { /* MuJoCo may name any point of the line of contact: what is across it counts */
      double along_y = dot(facing[2], at->axes[1]), along_z = dot(facing[2], at->axes[2]);
      double line = sqrt(along_y * along_y + along_z * along_z), across = first * along_z - second * along_y;
      first = line > 0 ? across / line : 0;
      const double* tilt = numbers->tilts + ((f * numbers->partners + g) * 3 + axis) * TILT;
      second = line > 0 ? (place[2] - looking[2] * dot(at->axes[0], away)) / line - tilt[RADIUS] * looking[2] : 0;
      whole = heat_tilted(tilt, exp(numbers->grid[0]), force, line > 0 ? looking[2] / line : 0, second, &lying);
    }
    if (whole > 0)
      conducts = whole * heat_curved(numbers->bent + table * CURVED, numbers->grid, lying / whole, first, second, &area, &length, shares);
    if (part > 0 && larger >= 0) {
      double others[4] = {0}, wide = 0, longer = 0;
      double more = heat_curved(numbers->bent + larger * CURVED, numbers->grid, lying, first, second, &wide, &longer, others);
      double one = (1 - part) * area, two = part * wide;
      for (int k = 0; k < 4; k++) shares[k] = one + two > 0 ? (one * shares[k] + two * others[k]) / (one + two) : 0;
      conducts = (1 - part) * conducts + part * more;
      area = one + two;
      length = sqrt((1 - part) * length * length + part * longer * longer);
    }
    area *= whole;
    length *= whole;
  } else if (bulging) {
    double sides[SIDES], longer, even;
    bool flat = !other && !views && curve[0] + curve[1] <= 0; /* fingertips and meshes count as level */
    for (int i = 0, n = 0; i < 3; i++)
      for (int k = 1; k < 3; k++)
        if (i != axis) sides[n++] = dot(facing[i], at->axes[k]);
        else sides[3 + k] = flat ? dot(facing[i], at->axes[k]) / dot(facing[i], at->axes[0]) : 0;
    if (!other && radii[0] > 0) on_ellipsoid(facing, at, radii, curve, bend, first, second, sides);
    sides[6] = other ? place[1] + first : 0;
    sides[7] = other ? place[2] + second : 0;
    Wedge beside;
    double on_face = heat_round_contact(bend, curve, sides, force, first, second, &area, &share, &longer, &even, &beside);
    if (area > 0 && share > 0) {
      conducts = heat_conductance(law, numbers, share / area) * area * on_face;
      area *= on_face * (1 - law->narrowing * (1 - even));
      length = sqrt(area * longer);
    }
    heat_beside_round(law, &beside, &conducts, &area, &length);
  } else {
    if (other) { /* along what lies between both pads' sides */
      double turn = atan2(dot(other->axes[1], at->axes[2]), dot(other->axes[1], at->axes[1]));
      turn = (turn - pi / 2 * floor(turn / (pi / 2) + 0.5)) / 2;
      double y = place[1], z = place[2];
      place[1] = y * cos(turn) + z * sin(turn);
      place[2] = z * cos(turn) - y * sin(turn);
    }
    heat_contact(law, force, place, &area, &share);
    /* of two fingertips both faces count as wide as what touches of them, whichever is named first */
    double wide = other ? 2 * law->half_face : numbers->pads[f * PAD + WIDTH];
    if (area > 0) length = heat_flat_patch(law, area, place, wide, shares);
    if (area > 0 && share > 0) conducts = heat_conductance(law, numbers, share / area) * area;
  }
  if (conducts > 0) {
    touch[CONDUCTANCE] += conducts;
    touch[AREA] += area;
    touch[LENGTH] += area * length;
    for (int k = 0; k < 4; k++) touch[ASIDE + k] += area * shares[k];
    if (!again) {
      double paused = before - touch[CLOSED];
      if (paused > touch[PAUSED]) {
        touch[PAUSED] = paused;
        touch[PULSES] += 1;
      } else if (before == 0) {
        touch[PULSES] = 0.5;
      }
      touch[CLOSED] += 1;
    }
    again = true;
  }
  touch[FORCE] += force;
  subtract(at->middle, d->xpos + 3 * body, away);
  mju_mulMatTVec3(touch + PLACE, d->xmat + 9 * body, away);
  mju_mulMatTVec3(touch + NORMAL, d->xmat + 9 * body, at->axes[0]);
  return again;
}

/* Adds the contacts of the step that was just taken to the state's touches. A force that is not finite is left out: MuJoCo resets
the simulation then. */
void heat_read(const Numbers* numbers, const Work* work, const mjModel* m, const mjData* d, const State* state) {
  int tips = numbers->fingers, partners = numbers->partners;
  bool any = false;
  double* pushed = work->room; /* (F, N, 3) */
  Pose poses[tips];
  for (int c = 0; c < d->ncon; c++) {
    const mjContact* contact = &d->contact[c];
    if (contact->geom[0] < 0 || contact->geom[1] < 0 || contact->efc_address < 0) continue;
    int first = work->role[contact->geom[0]], second = work->role[contact->geom[1]];
    if (first < 0 || second < 0 || first == second) continue;
    double sign = 1, y, z, other_y, other_z;
    if (first >= tips || (second < tips && second < first)) {
      int other = first;
      first = second;
      second = other;
      sign = -1;
    }
    if (first >= tips) continue;
    double force = d->efc_force[contact->efc_address];
    if (m->opt.cone == mjCONE_PYRAMIDAL)
      for (int k = 1; k < 2 * (contact->dim - 1); k++) force += d->efc_force[contact->efc_address + k];
    if (!(force > 0 && isfinite(force))) continue;
    if (!any) {
      memset(pushed, 0, sizeof(double) * tips * partners * 3);
      for (int f = 0; f < tips; f++) poses[f].known = false;
      any = true;
    }
    int partner = second >= tips ? second - tips : numbers->geoms + second;
    bool on = lies(numbers->pads + first * PAD, pose(numbers, work, d, first, poses), contact, sign, &y, &z);
    if (second < tips) {
      const Pose* other = pose(numbers, work, d, second, poses);
      on = lies(numbers->pads + second * PAD, other, contact, -sign, &other_y, &other_z) && on;
    }
    if (!on) continue;
    double* push = pushed + (first * partners + partner) * 3;
    push[0] += force;
    push[1] += force * y;
    push[2] += force * z;
  }
  for (int f = 0; any && f < tips; f++) {
    bool again = false;
    for (int g = 0, last = -1; g < partners; g++) {
      int target = g < numbers->geoms ? (int)numbers->owner[g] : numbers->objects + g - numbers->geoms;
      const double* push = pushed + (f * partners + g) * 3;
      again = again && target == last; /* an object's geoms follow one another */
      last = target;
      if (push[0] > 0)
        again = feel(numbers, work, d, f, g, push, poses, again, *state->count,
                     state->touches + (f * numbers->targets + target) * COLUMNS);
    }
  }
}
