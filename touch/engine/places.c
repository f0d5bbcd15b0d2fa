/* Places of objects, as touch/heat/places, joined.py and the first half of march.py: where a pad is on an object's box,
which places are remembered, and how an object's field survives a change of them. */

#include <math.h>
#include <string.h>

#include "heat.h"

#define NEAR 0.187501 /* of the sensor's width: a pad that is as near to a known place is on it */
#define GRID 0.125    /* of the sensor's width, on which places stand */
#define HARDLY 0.045  /* of what is seen best, by temperature: a flow that is seen so little counts half */
#define GROWTH 1.1    /* times what a field's states are, the root of what they store: a new network has no more */
#define TIE 1e-6      /* round-off does not decide where a pad is in the middle, between faces or points of the grid */
#define ANOTHER 0.1   /* by which another face of the box must look more at the pad than the one in use */
#define SOON 0.5      /* s, from when on what is lost with a place counts */
#define UNFELT 1e-3   /* K, that what is lost of a place that is forgotten without need may be felt as */
#define AT_ONCE 0.01  /* s, from when on */
#define RIDGE 1e-4    /* of a port's mean square */
#define ALIKE 1e-6    /* relative: round-off does not decide between places of which as much would be lost */

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

/* Whether a fingertip is on that place of an object. */
static bool in_use(const Numbers* numbers, const State* state, int o, int n) {
  for (int f = 0; f < numbers->tips; f++)
    if (state->current[f * numbers->objects + o] == n) return true;
  return false;
}

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
    int wholly = 0; /* of which networks have room for two of each fingertip */
    for (int n = 0; n < state->used[o]; n++) {
      double all = state->places[(o * numbers->places + n) * SLOT + ALL];
      if (!whole(all, in_use(numbers, state, o, n), 1)) return false;
      wholly += all != 0;
    }
    if (wholly > 2 * numbers->tips) return false;
  }
  return true;
}

size_t heat_carry_room(const Numbers* numbers) {
  size_t wide = 2 * (size_t)numbers->tips * numbers->patterns + IDLE, patterns = numbers->patterns;
  size_t forgets = 3 * wide * wide + 2 * patterns * patterns + 2 * wide, carries = numbers->states + 3 * wide + 4 * wide * wide;
  return carries > forgets ? carries : forgets;
}

/* The first state of a network after that one at whose rate it fades. */
static int next_rate(const Network* network, int first) {
  int i = first;
  while (i < network->n && network->rates[i] == network->rates[first]) i++;
  return i;
}

/* The states x of one rate by which some ports see what they saw, `wanted`: touch/heat/places/carry.py. seen: what each of
them sees of the states. room: 3 rows^2 + 2 rows. */
static void nearest(int columns, int rows, const double* wanted, const double* seen, double* x, double* room) {
  double *gram = room, *square = gram + rows * rows, *inverse = square + rows * rows, *mixed = inverse + rows * rows, trace = 0;
  mju_mulMatMatT(gram, seen, seen, rows, columns, rows);
  mju_mulMatMat(square, gram, gram, rows, rows, rows);
  for (int r = 0; r < rows; r++) trace += square[r * rows + r];
  if (!(trace > 0)) return;
  for (int r = 0; r < rows; r++) square[r * rows + r] += pow(HARDLY, 4) * trace;
  heat_inverse(rows, square, inverse);
  mju_mulMatVec(mixed, gram, wanted, rows, rows);
  mju_mulMatVec(mixed + rows, inverse, mixed, rows, rows);
  mju_mulMatTVec(x, seen, mixed + rows, rows, columns);
}

/* The field x on the states of a network with other places: of each rate those by which the common places see what they saw.
Where the states but the mean would grow by more than GROWTH, they are made smaller: from place to place a field must not
grow without end. */
void heat_carry(const Numbers* numbers, const Network* before, const Network* after, double* x, double* room) {
  int patterns = numbers->patterns, wide = before->count * patterns, from[wide + 1], to[wide + 1], rows = 0, old = before->n;
  for (int n = 0; n < before->count; n++) {
    for (int m = 0; m < after->count; m++) {
      const double *one = before->places + n * SLOT, *other = after->places + m * SLOT;
      if (memcmp(one, other, PLACED * sizeof(double))) continue;
      for (int p = 0; p < (one[ALL] != 0 && other[ALL] != 0 ? patterns : 1); p++) {
        from[rows] = n * patterns + p;
        to[rows++] = m * patterns + p;
      }
      break;
    }
  }
  double *was = room, *wanted = was + numbers->states, *seen = wanted + rows, stored = 0, now = 0;
  memcpy(was, x, sizeof(double) * old);
  for (int i = 1; i < old; i++) stored += x[i] * x[i];
  memset(x + 1, 0, sizeof(double) * (numbers->states - 1));
  for (int first = 1, last; first < after->n; first = last) {
    int begun = 1;
    last = next_rate(after, first);
    while (begun < old && before->rates[begun] != after->rates[first]) begun++;
    if (begun == old) continue;
    int ended = next_rate(before, begun), columns = last - first;
    for (int r = 0; r < rows; r++) {
      wanted[r] = 0;
      for (int i = begun; i < ended; i++) wanted[r] += before->ports[(size_t)from[r] * numbers->states + i] * was[i];
      memcpy(seen + (size_t)r * columns, after->ports + (size_t)to[r] * numbers->states + first, sizeof(double) * columns);
    }
    nearest(columns, rows, wanted, seen, x + first, seen + (size_t)rows * columns);
  }
  for (int i = 1; i < after->n; i++) now += x[i] * x[i];
  double most = GROWTH * sqrt(stored), size = sqrt(now);
  for (int i = 1; size > most && i < after->n; i++) x[i] *= most / size;
}

/* The idle place, not gone yet, without which the field x changes least: touch/heat/places/forgetting.py. Of such as good as
each other the first. -1 where there is none, or no need and something of its loss would be felt. */
int heat_forgotten(const Numbers* numbers, const Network* network, const double* x, const bool* idle, const bool* gone, bool need,
                   double* room) {
  bool any = false;
  for (int n = 0; n < network->count; n++) any = any || (idle[n] && !gone[n]);
  if (!any) return -1;
  int patterns = numbers->patterns, used[network->count * patterns + 1], few = heat_used_ports(numbers, network, used);
  int alive[few + 1], left = 0;
  for (int a = 0; a < few; a++)
    if (!gone[used[a] / patterns]) alive[left++] = a;
  double *gram = room, *remaining = gram + few * few, *inverse = remaining + left * left, *block = inverse + left * left;
  double *turned = block + patterns * patterns, *hears = turned + patterns * patterns, *flows = hears + few;
  double lost[network->count + 1], felt[network->count + 1], shown[network->count + 1], least = INFINITY;
  memset(lost, 0, sizeof lost);
  memset(felt, 0, sizeof felt);
  memset(shown, 0, sizeof shown);
  for (int first = 1, last; first < network->n; first = last) {
    last = next_rate(network, first);
    double ridge = 0, share = exp(-2 * network->rates[first] * SOON), soon = exp(-2 * network->rates[first] * AT_ONCE);
    for (int a = 0; a < few; a++) {
      const double* port = network->ports + (size_t)used[a] * numbers->states;
      hears[a] = 0;
      for (int i = first; i < last; i++) hears[a] += port[i] * x[i];
      for (int b = 0; b < few; b++) {
        gram[a * few + b] = 0;
        for (int i = first; i < last; i++)
          gram[a * few + b] += port[i] * network->ports[(size_t)used[b] * numbers->states + i];
      }
      ridge += RIDGE * gram[a * few + a] / few;
      if (used[a] % patterns == 0) shown[used[a] / patterns] += soon * gram[a * few + a];
    }
    for (int a = 0; a < left; a++)
      for (int b = 0; b < left; b++) remaining[a * left + b] = gram[alive[a] * few + alive[b]] + (a == b ? ridge : 0);
    heat_inverse(left, remaining, inverse);
    for (int a = 0; a < left; a++) {
      flows[a] = 0;
      for (int b = 0; b < left; b++) flows[a] += inverse[a * left + b] * hears[alive[b]];
    }
    for (int a = 0, end; a < left; a = end) {
      int n = used[alive[a]] / patterns;
      for (end = a; end < left && used[alive[end]] / patterns == n; end++) continue;
      if (!idle[n]) continue;
      int size = end - a;
      for (int i = 0; i < size * size; i++) block[i] = inverse[(a + i / size) * left + a + i % size];
      heat_inverse(size, block, turned);
      double each = 0;
      for (int i = 0; i < size * size; i++) each += flows[a + i / size] * turned[i] * flows[a + i % size];
      lost[n] += share * each;
      felt[n] += soon * each;
    }
  }
  for (int n = 0; n < network->count; n++)
    if (idle[n] && !gone[n]) least = lesser(least, lost[n]);
  int first = -1;
  for (int n = network->count - 1; n >= 0; n--) /* any number may have been written to the state */
    if (idle[n] && !gone[n] && !(lost[n] > least * (1 + ALIKE))) first = n;
  for (int n = network->count - 1; n >= 0 && !isfinite(least); n--)
    if (idle[n] && !gone[n]) first = n;
  return first >= 0 && !need && !(felt[first] * shown[first] <= UNFELT * UNFELT) ? -1 : first;
}

/* How many networks this process has made, by which tests see that they are kept. */
__attribute__((visibility("default"))) _Atomic unsigned long heat_networks_made;

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
  heat_network(numbers, o, network, work->impedances + o * heat_impedances(numbers), work->room);
  heat_networks_made++;
  return network;
}

/* Where a closed contact is: false where it is still at its place, else the face and where on the box, (2,) m. */
static bool moved(const Numbers* numbers, const State* state, int f, int o, int* face, double middle[2]) {
  const double* touch = state->touches + (f * numbers->targets + o) * COLUMNS;
  const double *box = numbers->boxes + o * BOX, width = numbers->pads[f * PAD + WIDTH];
  double looking[3] = {0}, position[3] = {0}, distance = 0;
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
    distance = greater(distance, fabs(middle[j] - place[MIDDLE + j]));
    j++;
  }
  return *face != known || distance > NEAR * width;
}

/* The place of the grid that is nearest to a middle on a face. */
static void on_grid(const Numbers* numbers, int f, int o, int face, const double middle[2], double* place) {
  double width = numbers->pads[f * PAD + WIDTH];
  place[FACE] = face;
  place[TIP] = f;
  place[ALL] = 1;
  for (int axis = 0, j = 0; axis < 3; axis++) {
    if (axis == face / 2) continue;
    double size = numbers->boxes[o * BOX + axis], room = greater(size - width, 0) / 2, spacing = GRID * width;
    double steps = rint((middle[j] - size / 2) / spacing * (1 - TIE));
    place[MIDDLE + j] = size / 2 + lesser(greater(steps * spacing, -room), room);
    j++;
  }
}

/* Brings those fingertips of an object that have a face in faces to their places: such as are known near there, or new ones;
touch/heat/places/moves.py. Where more than IDLE would be remembered besides those in use, others are forgotten. */
static void move(const Numbers* numbers, Work* work, State* state, int o, const int* faces, double (*middles)[2]) {
  int tips = numbers->tips, objects = numbers->objects, before = (int)state->used[o], count = before, kept = 0, over = -IDLE;
  double *remembered = state->places + o * numbers->places * SLOT, places[(numbers->places + tips) * SLOT];
  bool any = false, idle[numbers->places + tips], gone[numbers->places + tips], left[numbers->places + tips];
  Network* old = &work->networks[numbers->targets];
  heat_copy_network(numbers, network_of(numbers, work, state, o), old);
  memcpy(places, remembered, sizeof(double) * before * SLOT);
  memset(left, 0, sizeof left);
  for (int f = 0; f < tips; f++) {
    if (faces[f * objects + o] < 0) continue;
    double width = numbers->pads[f * PAD + WIDTH], *place = places + count * SLOT;
    on_grid(numbers, f, o, faces[f * objects + o], middles[f * objects + o], place);
    int at = 0, last = (int)state->current[f * objects + o];
    for (; at < count; at++) {
      const double* known = places + at * SLOT;
      double distance = greater(fabs(known[MIDDLE] - place[MIDDLE]), fabs(known[MIDDLE + 1] - place[MIDDLE + 1]));
      if (known[FACE] == place[FACE] && known[TIP] == place[TIP] && distance <= NEAR * width) break;
    }
    count += at == count;
    if (at == last) continue;
    if (last >= 0) left[last] = true;
    any = true;
    state->current[f * objects + o] = at;
  }
  if (!any) return;
  for (int n = 0; n < count; n++) {
    gone[n] = false;
    idle[n] = !in_use(numbers, state, o, n);
    places[n * SLOT + ALL] = !idle[n] || left[n];
    over += idle[n];
  }
  for (int n; (n = heat_forgotten(numbers, old, state->x + o * numbers->states, idle, gone, over > 0, work->room)) >= 0; over--)
    gone[n] = true;
  for (int n = 0; n < count; n++) {
    if (gone[n]) continue;
    memcpy(remembered + kept * SLOT, places + n * SLOT, sizeof(double) * SLOT);
    for (int f = 0; f < tips; f++) /* no number is looked at again: they only get smaller */
      if (state->current[f * objects + o] == n) state->current[f * objects + o] = kept;
    kept++;
  }
  state->used[o] = kept;
  const Network* network = network_of(numbers, work, state, o);
  if (kept == before && !memcmp(remembered, old->places, sizeof(double) * kept * SLOT)) return;
  heat_carry(numbers, old, network, state->x + o * numbers->states, work->room);
}

/* Brings every closed contact to its place. */
void heat_settle(const Numbers* numbers, Work* work, State* state) {
  int tips = numbers->tips, objects = numbers->objects, faces[tips * objects];
  double middles[tips * objects][2];
  for (int i = 0; i < tips * objects; i++) {
    int f = i / objects, o = i % objects;
    bool closed = state->touches[(f * numbers->targets + o) * COLUMNS + CONDUCTANCE] > 0;
    if (!closed || !moved(numbers, state, f, o, &faces[i], middles[i])) faces[i] = -1;
  }
  for (int o = 0; o < objects; o++) {
    bool any = false;
    for (int f = 0; f < tips; f++) any = any || faces[f * objects + o] >= 0;
    if (any) move(numbers, work, state, o, faces, middles);
    network_of(numbers, work, state, o);
  }
}
