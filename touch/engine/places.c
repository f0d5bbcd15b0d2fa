/* Places of objects, as touch/heat/fields.py, joined.py and the first half of march.py: where a pad is on an object's box,
and how an object's field survives a new place. */

#include <float.h>
#include <math.h>
#include <string.h>

#include "heat.h"

#define NEAR 0.250001 /* of the sensor's width: a pad that is as near to a known place is on it */
#define GRID 0.125    /* of the sensor's width, on which places stand */
#define LEAST 7e-4    /* singular values below that share of the largest are left out */
#define GROWTH 1.1    /* times what a field's states are, the root of what they store: a new network has no more */
#define TIE 1e-6      /* round-off does not decide where a pad is in the middle, between faces or points of the grid */
#define ANOTHER 0.1   /* by which another face of the box must look more at the pad than the one in use */
enum { IDLE = 2 };    /* places that an object remembers besides those in use */

size_t heat_states(const Numbers* numbers) {
  size_t tips = numbers->tips, objects = numbers->objects, fields = numbers->targets;
  return 1 + tips * fields * COLUMNS + objects * (numbers->places * SLOT + 1) + tips * objects +
         tips * fields * numbers->rates + objects * numbers->states + tips * (numbers->tip_states + CHAIN + numbers->links);
}

State heat_state(const Numbers* numbers, double* at) {
  size_t tips = numbers->tips, objects = numbers->objects;
  State state = {.count = at, .touches = at + 1};
  state.places = state.touches + tips * numbers->targets * COLUMNS;
  state.used = state.places + objects * numbers->places * SLOT;
  state.current = state.used + objects;
  state.narrow = state.current + tips * objects;
  state.x = state.narrow + tips * numbers->targets * numbers->rates;
  state.backs = state.x + objects * numbers->states + tips * numbers->tip_states;
  return state;
}

void heat_reset(const Numbers* numbers, double* at) {
  memset(at, 0, sizeof(double) * heat_states(numbers));
  State state = heat_state(numbers, at);
  for (int i = 0; i < numbers->tips * numbers->objects; i++) state.current[i] = -1;
  for (int o = 0; o < numbers->objects; o++) state.x[o * numbers->states] = numbers->boxes[o * BOX + FIRST];
  memcpy(state.backs, numbers->back_first, sizeof(double) * numbers->tips * (CHAIN + numbers->links));
  double* tip = state.x + numbers->objects * numbers->states;
  for (int i = 0; i < numbers->tips * numbers->tip_states; i++)
    tip[i] = numbers->first[i / numbers->tip_states] * numbers->tip_uniform[i];
}

static bool whole(double value, int least, int most) { return value >= least && value <= most && value == floor(value); }

/* Whether it can have been left by this plugin: whoever holds an mjData may have written anything. */
bool heat_valid(const Numbers* numbers, const State* state) {
  if (!whole(*state->count, 0, numbers->sample_steps - 1)) return false;
  for (int o = 0; o < numbers->objects; o++) {
    const double* box = numbers->boxes + o * BOX;
    if (!whole(state->used[o], 0, numbers->places)) return false;
    for (int n = 0; n < state->used[o]; n++) {
      const double* place = state->places + (o * numbers->places + n) * SLOT;
      if (!whole(place[FACE], 0, 5) || !whole(place[TIP], 0, numbers->tips - 1)) return false;
      for (int j = 0, i = 0; i < 3; i++) {
        if (i == (int)place[FACE] / 2) continue;
        if (!(place[MIDDLE + j] >= 0 && place[MIDDLE + j] <= box[i])) return false;
        j++;
      }
    }
    for (int f = 0; f < numbers->tips; f++)
      if (!whole(state->current[f * numbers->objects + o], -1, (int)state->used[o] - 1)) return false;
  }
  return true;
}

/* rows of temperatures at some places, afterwards: (n - 1, rows), a state's `stride` behind the one before */
static void future(const Numbers* numbers, const Network* network, int common, const int* at, double* out,
                   int stride) {
  int patterns = numbers->patterns, columns = network->n - 1;
  for (int p = 0; p < common * patterns; p++) {
    const double* port = network->ports + (size_t)(at[p / patterns] * patterns + p % patterns) * numbers->states + 1;
    for (int l = 0; l < AFTERWARDS; l++) {
      double later = numbers->afterwards[l], weight = sqrt(greater(later, numbers->afterwards[1]));
      for (int i = 0; i < columns; i++)
        out[(size_t)i * stride + p * AFTERWARDS + l] = port[i] * exp(-network->rates[i + 1] * later) * weight;
    }
  }
}

size_t heat_carry_room(const Numbers* numbers) {
  size_t rows = (size_t)numbers->places * numbers->patterns * AFTERWARDS, columns = numbers->states;
  return rows * columns + columns * columns + rows + 2 * columns;
}

/* The field x on the states of a network with other places, nearest to what both see alike from then on: by the singular
values of what is seen, found by one-sided rotations of its columns (Hestenes). Where the states but the mean would grow
by more than GROWTH, they are made smaller: from place to place a field must not grow without end. */
void heat_carry(const Numbers* numbers, const Network* before, const Network* after, double* x, double* room) {
  int from[before->count + 1], to[before->count + 1], common = 0;
  from[0] = to[0] = 0;
  for (int n = 0; n < before->count; n++) {
    for (int m = 0; m < after->count; m++) {
      if (memcmp(before->places + n * SLOT, after->places + m * SLOT, SLOT * sizeof(double))) continue;
      from[common] = n;
      to[common++] = m;
      break;
    }
  }
  int columns = after->n - 1, rows = common * numbers->patterns * AFTERWARDS, old = before->n - 1;
  int stride = rows + columns; /* behind what is seen of a state stands how it is turned */
  double *wanted = room, *seen = wanted + rows, stored = 0, now = 0;
  for (int i = 0; i < old; i++) stored += x[i + 1] * x[i + 1];
  future(numbers, before, common, from, seen, rows);
  memset(wanted, 0, sizeof(double) * rows);
  for (int i = 0; i < old; i++)
    for (int r = 0; r < rows; r++) wanted[r] += seen[(size_t)i * rows + r] * x[i + 1];
  memset(x + 1, 0, sizeof(double) * (numbers->states - 1));
  if (!common) return;
  future(numbers, after, common, to, seen, stride);
  double largest = 0;
  for (int i = 0; i < columns * columns; i++) seen[(size_t)(i / columns) * stride + rows + i % columns] = i % (columns + 1) == 0;
  for (int sweep = 0; sweep < 30; sweep++) {
    bool turned = false;
    for (int p = 0; p < columns - 1; p++) {
      for (int q = p + 1; q < columns; q++) {
        double *restrict left = seen + (size_t)p * stride, *restrict right = seen + (size_t)q * stride;
        double a = 0, b = 0, c = 0;
        for (int r = 0; r < rows; r++) {
          a += left[r] * left[r];
          b += right[r] * right[r];
          c += left[r] * right[r];
        }
        largest = greater(largest, greater(a, b));
        if (fabs(c) <= 1e-14 * sqrt(a * b) || greater(a, b) < 1e-4 * LEAST * LEAST * largest) continue;
        turned = true;
        double ratio = (b - a) / (2 * c), tangent = copysign(1 / (fabs(ratio) + sqrt(ratio * ratio + 1)), ratio);
        double cosine = 1 / sqrt(tangent * tangent + 1), sine = tangent * cosine;
        for (int r = 0; r < stride; r++) {
          double one = left[r];
          left[r] = cosine * one - sine * right[r];
          right[r] = sine * one + cosine * right[r];
        }
      }
    }
    if (!turned) break;
  }
  largest = 0;
  for (int pass = 0; pass < 2; pass++) {
    for (int p = 0; p < columns; p++) {
      const double* column = seen + (size_t)p * stride;
      double size = 0, met = 0;
      for (int r = 0; r < rows; r++) {
        size += column[r] * column[r];
        met += column[r] * wanted[r];
      }
      double left = size - LEAST * LEAST * largest;
      if (pass == 0) largest = greater(largest, size);
      else if (left > 0)
        for (int i = 0; i < columns; i++) x[i + 1] += column[rows + i] * met * left / (size * size);
    }
  }
  for (int i = 0; i < columns; i++) now += x[i + 1] * x[i + 1];
  double most = GROWTH * sqrt(stored), size = sqrt(now);
  for (int i = 0; size > most && i < columns; i++) x[i + 1] *= most / size;
}

/* The network of the places that an object has now; made where it is neither in use nor aside, in place of that aside which
was in use the longest ago. */
static Network* network_of(const Numbers* numbers, Work* work, const State* state, int o) {
  Network *network = &work->networks[o], *aside = &work->networks[numbers->targets + 1 + o * work->aside], before = *network;
  const double* places = state->places + o * numbers->places * SLOT;
  int count = (int)state->used[o], at = work->turn[o];
#define IS_OF(one) ((one)->count == count && !memcmp((one)->places, places, count * SLOT * sizeof(double)))
  if (IS_OF(network)) return network;
  for (int i = 0; i < work->aside; i++) {
    int next = (work->turn[o] + i) % work->aside;
    if (!IS_OF(aside + next)) continue;
    at = next;
    break;
  }
  *network = aside[at];
  aside[at] = before;
  work->turn[o] = (at + 1) % work->aside;
  if (IS_OF(network)) return network;
#undef IS_OF
  network->count = count;
  memcpy(network->places, places, count * SLOT * sizeof(double));
  heat_network(numbers, o, network, work->room);
  return network;
}

/* A new place of an object; of those that are idle the oldest goes where there would be too many. */
static void add(const Numbers* numbers, Work* work, State* state, int o, const double* place) {
  int count = (int)state->used[o], idle = 0, oldest = -1, objects = numbers->objects, tip = (int)place[TIP];
  double* places = state->places + o * numbers->places * SLOT;
  for (int n = count - 1; n >= 0; n--) {
    bool used = false;
    for (int f = 0; f < numbers->tips; f++) used |= f != tip && state->current[f * objects + o] == n;
    if (!used) oldest = n, idle++;
  }
  Network *network = network_of(numbers, work, state, o), *before = &work->networks[numbers->targets];
  heat_copy_network(numbers, network, before);
  if (idle > IDLE || count == numbers->places) {
    memmove(places + oldest * SLOT, places + (oldest + 1) * SLOT, sizeof(double) * SLOT * (count - oldest - 1));
    count--;
    for (int f = 0; f < numbers->tips; f++) {
      double* current = &state->current[f * objects + o];
      *current = *current == oldest ? -1 : *current > oldest ? *current - 1 : *current;
    }
  }
  memcpy(places + count * SLOT, place, sizeof(double) * SLOT);
  state->used[o] = count + 1;
  state->current[tip * objects + o] = count;
  heat_carry(numbers, before, network_of(numbers, work, state, o), state->x + o * numbers->states, work->room);
}

/* Where a closed contact is: false where it is still at its place, else the face and where on the box, (2,) m. */
static bool moved(const Numbers* numbers, const State* state, int f, int o, int* face, double middle[2]) {
  const double* touch = state->touches + (f * numbers->targets + o) * COLUMNS;
  const double *box = numbers->boxes + o * BOX, width = numbers->pads[f * PAD + WIDTH];
  double looking[3] = {0}, position[3] = {0}, apart = 0;
  int most = 0, current = (int)state->current[f * numbers->objects + o], known = -1;
  const double* place = state->places + (o * numbers->places + (current < 0 ? 0 : current)) * SLOT;
  for (int i = 0; i < 3; i++) {
    for (int k = 0; k < 3; k++) {
      looking[i] += box[TURN + 3 * k + i] * touch[NORMAL + k];
      position[i] += box[TURN + 3 * k + i] * (touch[PLACE + k] - box[CENTRE + k]);
    }
    position[i] *= box[i] / box[EXTENT + i];
    if (fabs(looking[i]) > fabs(looking[most]) + TIE) most = i;
  }
  if (current >= 0) {
    known = (int)place[FACE];
    if (fabs(looking[known / 2]) > fabs(looking[most]) - ANOTHER) most = known / 2;
  }
  *face = 2 * most + (looking[most] < 0); /* the pad looks inward */
  for (int i = 0, j = 0; i < 3; i++) {
    if (i == most) continue;
    double room = greater(box[i] - width, 0) / 2;
    middle[j] = box[i] / 2 + lesser(greater(position[i], -room), room);
    apart = greater(apart, fabs(middle[j] - place[MIDDLE + j]));
    j++;
  }
  return *face != known || apart > NEAR * width;
}

/* Brings every closed contact to its place: one that is known near there, or a new one. */
void heat_settle(const Numbers* numbers, Work* work, State* state) {
  int tips = numbers->tips, objects = numbers->objects, faces[tips * objects];
  double middles[tips * objects][2];
  for (int i = 0; i < tips * objects; i++) {
    int f = i / objects, o = i % objects;
    bool closed = state->touches[(f * numbers->targets + o) * COLUMNS + CONDUCTANCE] > 0;
    if (!closed || !moved(numbers, state, f, o, &faces[i], middles[i])) faces[i] = -1;
  }
  for (int i = 0; i < tips * objects; i++) {
    if (faces[i] < 0) continue;
    int o = i % objects, at = -1;
    double width = numbers->pads[i / objects * PAD + WIDTH], place[SLOT] = {faces[i], 0, 0, i / objects};
    for (int axis = 0, j = 0; axis < 3; axis++) {
      if (axis == faces[i] / 2) continue;
      double size = numbers->boxes[o * BOX + axis], room = greater(size - width, 0) / 2, spacing = GRID * width;
      double steps = rint((middles[i][j] - size / 2) / spacing * (1 - TIE));
      place[MIDDLE + j] = size / 2 + lesser(greater(steps * spacing, -room), room);
      j++;
    }
    for (int n = 0; n < (int)state->used[o] && at < 0; n++) {
      const double* known = state->places + (o * numbers->places + n) * SLOT;
      double apart = greater(fabs(known[MIDDLE] - place[MIDDLE]), fabs(known[MIDDLE + 1] - place[MIDDLE + 1]));
      if (known[FACE] == place[FACE] && known[TIP] == place[TIP] && apart <= NEAR * width) at = n;
    }
    if (at >= 0) state->current[i] = at;
    else add(numbers, work, state, o, place);
  }
  for (int o = 0; o < objects; o++) network_of(numbers, work, state, o);
}
