/* Contacts of a step as conductances, as touch/contacts/reader.py. */

#include <math.h>
#include <string.h>

#include "heat.h"

#define DEPTH 0.004  /* m off the pad's plane, up to which a contact is on it, beside half of what the two have sunk in */
#define RIM 0.0005   /* m beyond the pad's sides */
#define LOOKING 0.6  /* least cosine between the pad's normal and the contact's */

/* A pad in the world: its middle and its axes in columns. */
typedef struct {
  bool known;
  double middle[3], axes[9];
} Pose;

/* Of pad f in this step, found when it is first asked for. */
static const Pose* pose(const Numbers* numbers, const Work* work, const mjData* d, int f, Pose* poses) {
  Pose* found = poses + f;
  if (found->known) return found;
  int body = work->body[numbers->geoms + f];
  const double *pad = numbers->pads + f * PAD, *turn = d->xmat + 9 * body;
  found->known = true;
  for (int k = 0; k < 3; k++) {
    found->middle[k] = d->xpos[3 * body + k];
    for (int j = 0; j < 3; j++) found->middle[k] += turn[3 * k + j] * pad[j];
    for (int a = 0; a < 3; a++) {
      found->axes[3 * k + a] = 0;
      for (int j = 0; j < 3; j++) found->axes[3 * k + a] += turn[3 * k + j] * pad[AXES + 3 * j + a];
    }
  }
  return found;
}

/* Whether a contact is on a pad and looks at it, and where, m along its y and z. */
static bool lies(const double* pad, const Pose* at, const mjContact* contact, double sign, double* y, double* z) {
  double x = 0, along = 0, sunk = fmax(-contact->dist, 0) / 2;
  *y = *z = 0;
  for (int k = 0; k < 3; k++) {
    double away = contact->pos[k] - at->middle[k];
    along += sign * at->axes[3 * k] * contact->frame[k];
    x += away * at->axes[3 * k];
    *y += away * at->axes[3 * k + 1];
    *z += away * at->axes[3 * k + 2];
  }
  return along >= LOOKING && fabs(x) <= DEPTH + sunk && fabs(*y) <= pad[HALF] + RIM && fabs(*z) <= pad[HALF + 1] + RIM;
}

/* The view of a mesh that a pad belongs to, and where it is there, as touch/contacts/views.py. place: of the pad's middle. */
static int viewed(const double* views, int count, const double normal[3], const double p[3], double half, double at[2]) {
  int best = 0;
  double most = -2, q[3];
  for (int k = 0; k < count; k++) {
    const double* v = views + k * VIEW;
    double cosine = v[0] * normal[0] + v[1] * normal[1] + v[2] * normal[2];
    if (cosine > most) {
      most = cosine;
      best = k;
    }
  }
  const double* v = views + best * VIEW;
  double c[3], once[3], twice[3];
  mju_cross(c, normal, v);
  mju_cross(once, c, p);
  mju_cross(twice, c, once);
  for (int i = 0; i < 3; i++) q[i] = p[i] + once[i] + twice[i] / (1 + most);
  for (int j = 0; j < 2; j++) at[j] = fmax(mju_dot3(v + 3 * (j + 1), q) - v[9 + j] + half, 0);
  return best;
}

/* Adds what presses one pad on one thing to the touch. pushed: force N and its moments. again: whether another geom of the
target has been counted in this step. Returns whether one has now. */
static bool feel(const Numbers* numbers, const Work* work, const mjData* d, int f, int g, const double pushed[3],
                 Pose* poses, bool again, double* touch) {
  const Pose* at = pose(numbers, work, d, f, poses);
  int geom = work->geom[g], body = work->body[g], axis = 0;
  double force = pushed[0], place[3] = {0}, most = 0, area = 0, share = 0, length = 0, conducts = 0;
  const double* turn = geom >= 0 ? d->geom_xmat + 9 * geom : NULL;
  if (turn) {
    for (int i = 0; i < 3; i++) {
      double looking = 0;
      for (int k = 0; k < 3; k++) {
        looking += turn[3 * k + i] * at->axes[3 * k];
        place[i] += turn[3 * k + i] * (at->middle[k] - d->geom_xpos[3 * geom + k]);
      }
      if (fabs(looking) > most) {
        most = fabs(looking);
        axis = i;
      }
    }
  } else { /* another fingertip: how far the pads' middles are apart along this one's sides */
    const Pose* other = pose(numbers, work, d, g - numbers->geoms, poses);
    for (int k = 0; k < 3; k++)
      for (int j = 1; j < 3; j++) place[j] += (at->middle[k] - other->middle[k]) * at->axes[3 * k + j];
  }
  const Law* law = (const Law*)numbers->laws + (f * numbers->things + g) * 3 + axis;
  const double *bend = numbers->bends + f * BEND, *curve = numbers->curves + (g * 3 + axis) * CURVES;
  bool bulging = bend[0] + bend[1] > 0 || (!turn && curve[0] + curve[1] > 0);
  double on_face = 1, longer = 1;
  int side = axis, views = (int)numbers->viewed[g];
  double seen[2], normal[3];
  if (views && !bulging) {
    for (int i = 0; i < 3; i++) normal[i] = turn[i] * at->axes[0] + turn[3 + i] * at->axes[3] + turn[6 + i] * at->axes[6];
    side = viewed(numbers->views + g * numbers->sides * VIEW, views, normal, place, law->half_face, seen);
  }
  int table = (int)numbers->curved[(f * numbers->things + g) * numbers->sides + side];
  if (table >= 0 && !bulging) {
    double first = pushed[1] / force, second = pushed[2] / force, lying = force, whole = 1;
    if (views) {
      first = seen[0];
      second = seen[1];
    } else if (law->shape == SHAPE_CYLINDER) { /* MuJoCo may name any point of the line of contact: what is across it counts */
      double along_y = 0, along_z = 0;
      for (int k = 0; k < 3; k++) {
        along_y += at->axes[3 * k + 1] * turn[3 * k + 2];
        along_z += at->axes[3 * k + 2] * turn[3 * k + 2];
      }
      double line = sqrt(along_y * along_y + along_z * along_z), across = first * along_z - second * along_y;
      first = line > 0 ? across / line : 0;
      double slope = 0, away = 0;
      for (int k = 0; k < 3; k++) {
        slope += turn[3 * k + 2] * at->axes[3 * k];
        away += at->axes[3 * k] * (at->middle[k] - d->geom_xpos[3 * geom + k]);
      }
      second = line > 0 ? (place[2] - slope * away) / line : 0;
      const double* tilt = numbers->tilts + ((f * numbers->things + g) * 3 + axis) * TILT;
      whole = heat_tilted(tilt, exp(numbers->grid[0]), force, line > 0 ? slope / line : 0, second, &lying);
    }
    if (whole > 0)
      conducts = whole * heat_curved(numbers->bent + table * CURVED, numbers->grid, lying / whole, first, second, &area, &length);
    area *= whole;
    length *= whole;
  } else if (bulging) {
    double sides[4] = {0};
    const Pose* other = turn ? at : pose(numbers, work, d, g - numbers->geoms, poses);
    for (int i = 0, n = 0; i < 3; i++) {
      if (i == (turn ? axis : 0)) continue;
      for (int k = 0; k < 3; k++) {
        double points = turn ? turn[3 * k + i] : other->axes[3 * k + i];
        sides[2 * n] += points * at->axes[3 * k + 1];
        sides[2 * n + 1] += points * at->axes[3 * k + 2];
      }
      n++;
    }
    on_face = heat_round_contact(bend, curve, sides, force, pushed[1] / force, pushed[2] / force, &area, &share,
                                 &longer);
  } else {
    heat_contact(law, force, place, &area, &share);
  }
  if (area > 0 && share > 0) {
    conducts = heat_conductance(law, numbers, share / area) * area * on_face;
    area *= on_face;
    length = sqrt(area * longer);
  }
  if (conducts > 0) {
    touch[CONDUCTANCE] += conducts;
    touch[AREA] += area;
    touch[LENGTH] += area * length;
    if (!again) touch[CLOSED] += 1;
    again = true;
  }
  touch[FORCE] += force;
  const double *rotation = d->xmat + 9 * body, *origin = d->xpos + 3 * body;
  for (int i = 0; i < 3; i++) {
    touch[PLACE + i] = touch[NORMAL + i] = 0;
    for (int k = 0; k < 3; k++) {
      touch[PLACE + i] += rotation[3 * k + i] * (at->middle[k] - origin[k]);
      touch[NORMAL + i] += rotation[3 * k + i] * at->axes[3 * k];
    }
  }
  return again;
}

/* Adds the contacts of the step that was just taken to the touches. A force that is not finite is left out: MuJoCo resets
the simulation then. */
void heat_read(const Numbers* numbers, const Work* work, const mjModel* m, const mjData* d, double* touches) {
  int tips = numbers->tips, things = numbers->things;
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
      memset(pushed, 0, sizeof(double) * tips * things * 3);
      for (int f = 0; f < tips; f++) poses[f].known = false;
      any = true;
    }
    int thing = second >= tips ? second - tips : numbers->geoms + second;
    bool on = lies(numbers->pads + first * PAD, pose(numbers, work, d, first, poses), contact, sign, &y, &z);
    if (second < tips) {
      const Pose* other = pose(numbers, work, d, second, poses);
      on = lies(numbers->pads + second * PAD, other, contact, -sign, &other_y, &other_z) && on;
    }
    if (!on) continue;
    double* own = pushed + (first * things + thing) * 3;
    own[0] += force;
    own[1] += force * y;
    own[2] += force * z;
  }
  for (int f = 0; any && f < tips; f++) {
    bool again = false;
    for (int g = 0, last = -1; g < things; g++) {
      int target = g < numbers->geoms ? (int)numbers->owner[g] : numbers->objects + g - numbers->geoms;
      const double* own = pushed + (f * things + g) * 3;
      again = again && target == last; /* an object's geoms follow one another */
      last = target;
      if (own[0] > 0)
        again = feel(numbers, work, d, f, g, own, poses, again, touches + (f * numbers->targets + target) * COLUMNS);
    }
  }
}
