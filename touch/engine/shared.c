/* Contacts that share a sensor's face: what the heat of one does where another is; touch/heat/narrow/shared.py. */

#include <math.h>
#include <string.h>

#include "heat.h"

#define HALF_TURN 3.141592653589793
#define APART 1e-3      /* of the face's width, an overlap that is worth as much as lying apart by all of it */
#define ALIKE 1e-9      /* of the face's area, by which sides that are as good as the best may be worse */
#define FIRM (1 + 1e-9) /* by which contacts have more than they have of one another */

/* m, along both axes of the face */
typedef struct {
  double length[2], offset[2];
} Placed;

typedef struct {
  double along[2][FACE_MODES];
} Waves;

static Placed placed(const double* touch, double width) {
  Placed place = {{width, width}, {0, 0}};
  if (touch[AREA] > 0) {
    double area = touch[AREA] / touch[CLOSED];
    place.length[0] = lesser(area / (touch[LENGTH] / touch[AREA]), width);
    place.length[1] = lesser(area / place.length[0], width);
    for (int a = 0; a < 2; a++) {
      if (!(place.length[a] > 0)) place.length[a] = width; /* any number may have been written to the state */
      place.offset[a] = heat_offset_of(touch[ASIDE + a] / touch[AREA], place.length[a], width);
    }
  }
  return place;
}

/* Which of contacts begin .. end of a face, at those places, share it: the largest, in their order. */
static int chosen(const Placed* places, int count, int members[SHARED]) {
  int found = 0;
  for (int i = 0; i < count; i++) {
    int larger = 0;
    double area = places[i].length[0] * places[i].length[1];
    for (int j = 0; j < count; j++) {
      double other = places[j].length[0] * places[j].length[1];
      larger += other > area || (other == area && j < i);
    }
    if (larger < SHARED && found < SHARED) members[found++] = i;
  }
  return found;
}

static double offset_of(const Placed* place, int axis, int flips, int a) {
  return flips >> a & 1 ? -place->offset[axis] : place->offset[axis];
}

/* What lying on those sides costs: how much contacts overlap, less how far they lie apart. */
static double cost_of(const Placed* places, const int* members, int count, const int flips[2], double width) {
  double cost = 0;
  for (int a = 0; a < count; a++) {
    for (int b = 0; b < a; b++) {
      const Placed *one = places + members[a], *other = places + members[b];
      double overlap = 1, apart = 0;
      for (int axis = 0; axis < 2; axis++) {
        double off = fabs(offset_of(one, axis, flips[axis], a) - offset_of(other, axis, flips[axis], b));
        overlap *= greater((one->length[axis] + other->length[axis]) / 2 - off, 0);
        apart += off;
      }
      cost += overlap - APART * width * apart;
    }
  }
  return cost;
}

/* Gives the members' offsets signs. */
static void choose_sides(Placed* places, const int* members, int count, double width) {
  int ways = 1 << (count - 1); /* the first is on one side */
  double least = INFINITY;
  for (int way = 0; way < ways * ways; way++) {
    int flips[2] = {way << 1, way / ways << 1};
    least = lesser(cost_of(places, members, count, flips, width), least);
  }
  for (int way = 0; way < ways * ways; way++) {
    int flips[2] = {way << 1, way / ways << 1};
    if (!(cost_of(places, members, count, flips, width) <= least + ALIKE * width * width)) continue;
    for (int a = 0; a < count; a++)
      for (int axis = 0; axis < 2; axis++) places[members[a]].offset[axis] = offset_of(places + members[a], axis, flips[axis], a);
    return;
  }
}

static Waves waves_of(const Placed* place, double width) {
  Waves waves;
  for (int axis = 0; axis < 2; axis++) {
    waves.along[axis][0] = 1;
    for (int n = 1; n < FACE_MODES; n++) {
      double half = n * HALF_TURN * place->length[axis] / (2 * width);
      waves.along[axis][n] = cos(n * HALF_TURN * (place->offset[axis] / width + 0.5)) * sin(half) / half;
    }
  }
  return waves;
}

/* Fills squares (K) with what contacts of these waves have of one another. */
static void couple(const Waves* one, const Waves* other, const double* modes, int rates, double* squares) {
  memset(squares, 0, sizeof(double) * rates);
  for (int n = 0; n < FACE_MODES; n++) {
    double along = one->along[0][n] * other->along[0][n] * (n > 0 ? 2 : 1);
    for (int m = 0; m < FACE_MODES; m++) {
      double both = along * one->along[1][m] * other->along[1][m] * (m > 0 ? 2 : 1);
      for (int k = 0; k < rates; k++) squares[k] += both * modes[(n * FACE_MODES + m) * rates + k];
    }
  }
}

/* Fills squares (K) with what a contact has in all; its waves become smaller where its own (K) is less. */
static void part(const double* own, Waves* waves, const double* modes, const double* decay, int rates, const double* root, double* squares) {
  couple(waves, waves, modes, rates, squares);
  double known = 0, total = 0, beyond = 0;
  for (int k = 0; k < rates; k++) {
    known += squares[k] / decay[k];
    total += own[k] / decay[k];
  }
  double less = known > 0 ? lesser(total / known, 1) : 1;
  for (int n = 0; n < FACE_MODES; n++) waves->along[0][n] *= sqrt(less);
  for (int k = 0; k < rates; k++) beyond += greater(own[k] - less * squares[k], 0) / decay[k];
  double rest = beyond > 0 ? greater(total - less * known, 0) / beyond : 0;
  for (int k = 0; k < rates; k++)
    squares[k] = FIRM * (less * squares[k] + rest * greater(own[k] - less * squares[k], 0) + greater(root[k] * root[k] - own[k], 0));
}

/* What contacts of one face do to one another. own: (pairs, K) of the pads' sides. Fills order (pairs) and members (pairs,
SHARED), which of those that share a face a contact is, or -1, and the others before it; lower (pairs, SHARED, K) and mutual
(pairs, SHARED) K/W, by the number of the other. Changes roots (pairs, K), and adds to resistance and difference. */
void heat_share_faces(const Numbers* numbers, const Work* work, const State* state, int pairs, const int* pair, const double* own,
                      double* roots, double* resistance, double* difference, int* order, int* members, double* lower, double* mutual) {
  int targets = numbers->targets, rates = numbers->rates;
  for (int i = 0; i < pairs; i++) order[i] = -1;
  for (int begin = 0, end; begin < pairs; begin = end) {
    int f = pair[begin] / targets, who[SHARED];
    for (end = begin + 1; end < pairs && pair[end] / targets == f; end++) continue;
    if (end == begin + 1) continue;
    double width = numbers->pads[f * PAD + WIDTH];
    const double* modes = numbers->modes + (size_t)f * FACE_MODES * FACE_MODES * rates;
    Placed places[end - begin];
    for (int i = begin; i < end; i++) places[i - begin] = placed(state->touches + pair[i] * COLUMNS, width);
    int count = chosen(places, end - begin, who);
    choose_sides(places, who, count, width);
    Waves waves[SHARED];
    for (int a = 0; a < count; a++) {
      int i = begin + who[a];
      double* row = lower + (size_t)i * SHARED * rates;
      order[i] = a;
      waves[a] = waves_of(places + who[a], width);
      part(own + i * rates, waves + a, modes, numbers->decay, rates, roots + i * rates, row + a * rates);
      for (int b = 0; b < a; b++) {
        int j = members[i * SHARED + b] = begin + who[b];
        const double* other = lower + (size_t)j * SHARED * rates;
        couple(waves + a, waves + b, modes, rates, row + b * rates);
        for (int k = 0; k < rates; k++) {
          double value = row[b * rates + k];
          for (int n = 0; n < b; n++) value -= row[n * rates + k] * other[n * rates + k];
          value = other[b * rates + k] > 0 ? value / other[b * rates + k] : 0;
          row[b * rates + k] = value;
          row[a * rates + k] -= value * value;
        }
      }
      for (int k = 0; k < rates; k++) {
        double* root = roots + i * rates + k;
        double share = work->grown[k] / numbers->dt, lag = (1 - share) / numbers->decay[k]; /* of a state that fades, over the step */
        row[a * rates + k] = sqrt(greater(row[a * rates + k], 0));
        double behind = (row[a * rates + k] - *root) * state->narrow[pair[i] * rates + k], more = -*root * *root;
        for (int n = 0; n <= a; n++) more += row[n * rates + k] * row[n * rates + k];
        resistance[i] += more * lag;
        *root = row[a * rates + k];
        for (int b = 0; b < a; b++) {
          int j = members[i * SHARED + b];
          const double* other = lower + (size_t)j * SHARED * rates;
          double both = 0;
          behind += row[b * rates + k] * state->narrow[pair[j] * rates + k];
          for (int n = 0; n <= b; n++) both += row[n * rates + k] * other[n * rates + k];
          if (k == 0) mutual[i * SHARED + b] = 0;
          mutual[i * SHARED + b] += both * lag;
        }
        difference[i] -= share * behind;
      }
    }
  }
}
