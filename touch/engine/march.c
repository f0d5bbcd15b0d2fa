/* A sample of heat: the fields that closed contacts join take one rational step of the exponential together;
touch/heat/systems.py, narrow.py and march.py, thermal/network/coupling.py and kernel.py. Groups that share no field are
distinct by the zeros between them. */

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "heat.h"

#define MOST 1e100 /* K/W, of a contact */

/* Of a function that is compiled for processors with wider registers too. None of these fuses or changes the order of
sums, so that all give the same bits. */
#if !defined(WIDER) && defined(__x86_64__) && defined(__gnu_linux__) && defined(__has_attribute)
#if __has_attribute(target_clones)
#define WIDER __attribute__((target_clones("avx2", "default")))
#endif
#endif
#ifndef WIDER
#define WIDER
#endif

/* What a closed contact sees of its target or of its fingertip: a port for each of its patterns, `sign` of it. */
typedef struct {
  int field, place, n, stride;
  double sign;
  const double* ports;
  const Complex* scale;
  double* x;
} Side;

static double* field(const Numbers* numbers, const State* state, int t) {
  int objects = numbers->objects;
  return t < objects ? state->x + t * numbers->states
                     : state->x + objects * numbers->states + (t - objects) * numbers->tip_states;
}

static Side side_of(const Numbers* numbers, const Work* work, const State* state, int t, int place, double sign) {
  const Network* network = work->networks + t;
  const double* ports = network->ports + (size_t)place * numbers->patterns * network->stride;
  return (Side){t, place, network->n, network->stride, sign, ports, network->scale, field(numbers, state, t)};
}

static const Complex one = {.real = {1, 1, 1, 1}};

/* From real and imaginary parts in turn, of every pole. */
static inline Complex at_poles(const double parts[2 * POLES], double behind) {
  return (Complex){{parts[0], parts[2], parts[4], behind}, {parts[1], parts[3], parts[5], 0}};
}

static inline double sum(const Four* a) { return ((*a)[0] + (*a)[2]) + ((*a)[1] + (*a)[3]); }

static inline Complex times(Complex a, Complex b) {
  return (Complex){a.real * b.real - a.imag * b.imag, a.real * b.imag + a.imag * b.real};
}

/* The sum of the real parts of a b. */
static inline double real_sum(Complex a, Complex b) {
  Four part = a.real * b.real - a.imag * b.imag;
  return sum(&part);
}

/* a + factor b */
static inline Complex plus(Complex a, double factor, Complex b) {
  return (Complex){a.real + factor * b.real, a.imag + factor * b.imag};
}

static inline Complex inverse_of(Complex a) {
  Four part = 1.0 / (a.real * a.real + a.imag * a.imag);
  return (Complex){a.real * part, -a.imag * part};
}

/* The temperature at a port of n states. */
static inline Complex seen_at(int n, const double* port, const double* x, const Complex* scale) {
  Complex all = {0}, others = {0}; /* two sums, neither of which waits for the other */
  int k = 0;
  for (; k + 1 < n; k += 2) {
    all = plus(all, port[k] * x[k], scale[k]);
    others = plus(others, port[k + 1] * x[k + 1], scale[k + 1]);
  }
  if (k < n) all = plus(all, port[k] * x[k], scale[k]);
  return plus(all, 1, others);
}

/* How the ports of a network hear one another where something may touch: of an object, whose places stand in the
network, those that are in use. */
static void hear(const Numbers* numbers, const Network* network, bool tip) {
  int patterns = numbers->patterns, wide = network->count * patterns;
  for (int p = 0; p < wide; p++) {
    const double* port = network->ports + (size_t)p * network->stride;
    if (!tip && network->places[p / patterns * SLOT + ALL] == 0) continue;
    for (int r = 0; r <= p; r++)
      if (tip || network->places[r / patterns * SLOT + ALL] != 0) network->gram[p * wide + r] = network->gram[r * wide + p] =
          seen_at(network->n, port, network->ports + (size_t)r * network->stride, network->scale);
  }
}

/* What a network's step needs besides its ports. tip: whether it is a fingertip's. */
void heat_pace(const Numbers* numbers, Network* network, bool tip) {
  Complex poles = at_poles(numbers->poles, 1), weights = at_poles(numbers->weights, 0);
  for (int i = 0; i < network->n; i++) {
    double rate = numbers->dt * network->rates[i];
    network->scale[i] = inverse_of(plus(poles, rate, one));
    network->kept[i] = 1 + 2 * rate * real_sum(weights, network->scale[i]);
    network->fade[i] = exp(-rate);
  }
  hear(numbers, network, tip);
}

/* Room for a step of m ports. Returns false where there is no memory. */
static bool has_room(Work* work, size_t m) {
  if (m <= work->ports && work->matrix) return true;
  free(work->matrix);
  work->matrix = malloc(sizeof(Complex) * ((m + 1) * m + 1)); /* never empty */
  work->ports = work->matrix ? m : 0;
  return work->matrix;
}

/* dt times how the closed contacts' ports hear one another, the lower half of (m, m). */
WIDER static void join(const Numbers* numbers, const Work* work, const Side* sides, int pairs) {
  int patterns = numbers->patterns, m = pairs * patterns;
  memset(work->matrix, 0, sizeof(Complex) * m * m);
  for (int one = 0; one < 2 * pairs; one++) {
    for (int other = 0; other < 2 * (one / 2 + 1); other++) {
      const Side *one_side = sides + one, *other_side = sides + other;
      if (one_side->field != other_side->field) continue;
      const Network* network = work->networks + one_side->field;
      int wide = network->count * patterns;
      double sign = numbers->dt * one_side->sign * other_side->sign;
      for (int p = 0; p < patterns; p++) {
        const Complex* heard = network->gram + (size_t)(one_side->place * patterns + p) * wide + other_side->place * patterns;
        Complex* at = work->matrix + (size_t)(one / 2 * patterns + p) * m + other / 2 * patterns;
        for (int r = 0; r < patterns; r++) at[r] = plus(at[r], sign, heard[r]);
      }
    }
  }
}

static bool zero(const Complex* a) {
  const double* parts = (const double*)a;
  for (size_t i = 0; i < sizeof *a / sizeof(double); i++)
    if (parts[i] != 0) return false;
  return true;
}

/* Solves a symmetric matrix (m, m) at every pole, of which the lower half counts and is lost; no pivots, as they are never
small (thermal/batch/step.py). */
WIDER static void solve(int m, Complex* matrix, Complex* x) {
  for (int c = 0; c < m; c++) {
    matrix[c * m + c] = inverse_of(matrix[c * m + c]);
    for (int r = c + 1; r < m; r++) {
      if (zero(matrix + r * m + c)) continue;
      Complex factor = times(matrix[r * m + c], matrix[c * m + c]);
      for (int k = c + 1; k <= r; k++) matrix[r * m + k] = plus(matrix[r * m + k], -1, times(factor, matrix[k * m + c]));
      x[r] = plus(x[r], -1, times(factor, x[c]));
    }
  }
  for (int c = m - 1; c >= 0; c--) {
    for (int r = c + 1; r < m; r++) x[c] = plus(x[c], -1, times(matrix[r * m + c], x[r]));
    x[c] = times(x[c], matrix[c * m + c]);
  }
}

/* A step of every field; of each closed contact its sides, resistance K/W and difference K. mutual: (pairs, SHARED)
K/W of each with those that share its face and stand before it, of which order and members tell. through: its mean flow W. */
WIDER static void step(const Numbers* numbers, const Work* work, const State* state, int pairs, const Side* sides, const double* resistance,
                 const double* difference, const int* order, const int* members, const double* mutual, double* through) {
  int patterns = numbers->patterns, m = pairs * patterns;
  Complex *matrix = work->matrix, *flow = matrix + (size_t)m * m, poles = at_poles(numbers->poles, 1);
  join(numbers, work, sides, pairs);
  for (int j = 0; j < m; j++) {
    Complex heard = {0};
    for (const Side* side = sides + j / patterns * 2; side < sides + j / patterns * 2 + 2; side++)
      heard = plus(heard, side->sign, seen_at(side->n, side->ports + j % patterns * side->stride, side->x, side->scale));
    flow[j] = plus((Complex){0}, -1, times(poles, heard));
    if (j % patterns == 0) flow[j] = plus(flow[j], difference[j / patterns], one);
    matrix[j * m + j] = plus(matrix[j * m + j], resistance[j / patterns], one);
  }
  for (int i = 0; i < pairs; i++)
    for (int b = 0; b < order[i]; b++) {
      Complex* at = matrix + (size_t)i * patterns * m + members[i * SHARED + b] * patterns;
      *at = plus(*at, mutual[i * SHARED + b], one);
    }
  solve(m, matrix, flow);
  Complex weights = plus((Complex){0}, 2 * numbers->dt, at_poles(numbers->weights, 0));
  for (int j = 0; j < m; j++) {
    flow[j] = times(weights, flow[j]);
    if (j % patterns == 0) through[j / patterns] = -real_sum(flow[j], inverse_of(poles)) / numbers->dt;
  }
  for (int t = 0; t < numbers->targets; t++) {
    const Network* network = work->networks + t;
    double *x = field(numbers, state, t), *left = network->fade;
    for (int i = 0; i < 2 * pairs; i++)
      if (sides[i].field == t) left = network->kept;
    for (int k = 0; k < network->n; k++) x[k] *= left[k];
  }
  for (int i = 0; i < 2 * pairs; i++) {
    const Side* side = sides + i;
    const Complex* given = flow + i / 2 * patterns;
    for (int k = 0; k < side->n; k++) {
      Complex all = {0};
      for (int p = 0; p < patterns; p++) all = plus(all, side->ports[p * side->stride + k], given[p]);
      side->x[k] -= side->sign * real_sum(all, side->scale[k]);
    }
  }
}

/* K above the air behind an element. */
static double warm(const Numbers* numbers, const State* state, int f) {
  return state->backs[(f + 1) * (CHAIN + numbers->links) - 1];
}

/* What a fingertip's states x tell, by one of its rows. */
static double row(const Numbers* numbers, const double* rows, int f, const double* x) {
  double total = 0;
  for (int k = 0; k < numbers->tip_states; k++) total += rows[f * numbers->tip_states + k] * x[k];
  return total;
}

/* The width of a table before one that is a ratio-th of the sensor's, and the share of the way to the next. */
static int before(double ratio, double* share) {
  double narrow = lesser(2 * log2(ratio), WIDTHS - 1);
  int at = (int)lesser(narrow, WIDTHS - 2);
  *share = (exp2((narrow - at) / 2) - 1) / (sqrt(2) - 1);
  return at;
}

/* The share of a sensor's face under which an object is, at the place that is in use, and the axis across it. */
static double covered(const Numbers* numbers, const State* state, int f, int o, int* axis) {
  int number = (int)state->current[f * numbers->objects + o];
  *axis = 0;
  if (number < 0) return 1;
  const double *box = numbers->boxes + o * BOX, width = numbers->pads[f * PAD + WIDTH];
  *axis = (int)state->places[(o * numbers->places + number) * SLOT + FACE] / 2;
  double share = 1;
  for (int i = 0; i < AXES; i++)
    if (i != *axis) share *= lesser(box[i] / width, 1);
  return greater(rint(64 * share), 1) / 64;
}

/* The largest share, in eighths, that the contact of another pad of the same kind covers of what lies behind a contact's
   face; as touch/heat/narrow.py. */
static double pressed_behind(const Numbers* numbers, const State* state, const int* pair, int pairs, int f, int o) {
  int objects = numbers->objects, own = (int)state->current[f * objects + o];
  if (own < 0) return 0;
  const double* place = state->places + (o * numbers->places + own) * SLOT;
  double width = numbers->pads[f * PAD + WIDTH], most = 0;
  for (int j = 0; j < pairs; j++) {
    int g = pair[j] / numbers->targets, number;
    if (g == f || numbers->pad_kinds[g] != numbers->pad_kinds[f] || pair[j] % numbers->targets != o || (number = (int)state->current[g * objects + o]) < 0) continue;
    const double* other = state->places + (o * numbers->places + number) * SLOT;
    if ((int)other[FACE] != ((int)place[FACE] ^ 1)) continue;
    double covers = 1;
    for (int i = 0; i < 2; i++) covers *= greater(1 - fabs(other[MIDDLE + i] - place[MIDDLE + i]) / width, 0);
    most = greater(most, rint(8 * covers) / 8);
  }
  return most;
}

/* Fills root with the b_k of a narrow contact, and own with the squares of the pad's side; false where it is as wide as the
   face. axis: across the object's face. share: of the face on the object, from less than all of which its network knows how
   heat spreads. behind: the share that is pressed from the other side. */
static bool spread(const Numbers* numbers, int pair, const double* touch, int axis, double share, double behind, double* own, double* root) {
  if (!(touch[AREA] > 0)) return false;
  int tip = pair / numbers->targets, other_tip = pair % numbers->targets - numbers->objects, rates = numbers->rates;
  double area = touch[AREA] / touch[CLOSED];
  bool any = false;
  double way;
  int all = before(1 / share, &way);
  memset(root, 0, sizeof(double) * rates);
  for (int side = 0; side < 2; side++) {
    double width = numbers->pads[(side && other_tip >= 0 ? other_tip : tip) * PAD + WIDTH], u, v;
    double first = lesser(area / (touch[LENGTH] / touch[AREA]), width), second = lesser(area / first, width);
    /* any number may have been written to the state */
    if (!(first > 0 && second > 0 && lesser(first, second) < width * (1 - 1e-9))) continue;
    int i = before(width / first, &u), j = before(width / second, &v);
    any = true;
    double one = lesser(greater(touch[ASIDE + 2 * side] / touch[AREA], 0), 1);
    double other = lesser(greater(touch[ASIDE + 2 * side + 1] / touch[AREA], 0), 1);
    for (int place = 0; place < 4; place++) {
      int a = place & 1, b = place >> 1;
      double weight = (a ? one : 1 - one) * (b ? other : 1 - other), values[rates];
      if (!(weight > 0)) continue;
      memset(values, 0, sizeof values);
      for (int pinched = 0; pinched < 2; pinched++) {
        double part = side ? (pinched ? behind : 1 - behind) : !pinched;
        if (!(part > 0)) continue;
        int number = (1 + 2 * AXES) * pair + (side ? 1 + axis + AXES * pinched : 0);
        const double* known = numbers->narrow + ((size_t)numbers->spread[number] * SPREAD + (2 * a + b) * WIDTHS * WIDTHS) * rates;
        const double *near = known + (i * WIDTHS + j) * rates, *far = near + WIDTHS * rates;
        const double *along = known + all * WIDTHS * rates, *beside = known + all * rates;
        for (int k = 0; k < rates; k++) {
          values[k] += part * ((1 - u) * ((1 - v) * near[k] + v * near[k + rates]) + u * ((1 - v) * far[k] + v * far[k + rates]));
          if (side && share < 1) /* less what the network knows */
            values[k] -= part * greater((1 - way) * along[k] + way * along[k + WIDTHS * rates], (1 - way) * beside[k] + way * beside[k + rates]);
        }
      }
      for (int k = 0; k < rates; k++) root[k] += weight * greater(values[k], 0);
    }
    if (!side) memcpy(own, root, sizeof(double) * rates);
  }
  for (int k = 0; k < rates; k++) root[k] = sqrt(root[k]);
  return any;
}

/* What a contact that comes and goes within the sample resists beyond its mean, K/W, of faces that resist so much m2 K/W; as
   touch/heat/ripple.py. */
static double rippled(const Numbers* numbers, const double* touch, double faces) {
  double share = touch[CLOSED] / numbers->sample_steps, spread = share * (1 - share), root = sqrt(greater(spread, 0));
  if (!(spread > 0 && touch[AREA] > 0)) return 0;
  double pulses = touch[PULSES] - (touch[PAUSED] >= numbers->sample_steps - touch[CLOSED] ? 0.5 : 0); /* one goes on */
  double ripple = root * spread * (4.0 / 3 - 1.29 * root + 0.83 * spread) / (share * share * sqrt(greater(pulses, 1)));
  return faces * ripple * touch[CLOSED] / touch[AREA];
}

/* Advances every field by a sample. Returns false where there is no memory. */
bool heat_march(const Numbers* numbers, Work* work, State* state) {
  int tips = numbers->tips, objects = numbers->objects, targets = numbers->targets, rates = numbers->rates, pairs = 0;
  int pair[tips * targets];
  const Back* backs = (const Back*)numbers->backs;
  for (int i = 0; i < tips * targets; i++)
    if (state->touches[i * COLUMNS + CONDUCTANCE] > 0) pair[pairs++] = i;
  Side sides[2 * pairs + 1]; /* never empty */
  double resistance[pairs + 1], difference[pairs + 1], through[pairs + 1], roots[pairs * rates + 1];
  double own[pairs * rates + 1], lower[pairs * SHARED * rates + 1], mutual[pairs * SHARED + 1];
  int order[pairs + 1], members[pairs * SHARED + 1];
  memset(roots, 0, sizeof roots);
  memset(own, 0, sizeof own);
  for (int i = 0; i < pairs; i++) {
    int f = pair[i] / targets, t = pair[i] % targets;
    const double *touch = state->touches + pair[i] * COLUMNS, *states = state->narrow + pair[i] * rates;
    double* root = roots + i * rates;
    sides[2 * i] = side_of(numbers, work, state, t, t < objects ? (int)state->current[f * objects + t] : numbers->faces - 1, 1);
    sides[2 * i + 1] = side_of(numbers, work, state, objects + f, 0, -1);
    resistance[i] = lesser(numbers->sample_steps / touch[CONDUCTANCE], MOST);
    difference[i] = warm(numbers, state, f) - (t >= objects ? warm(numbers, state, t - objects) : 0);
    int axis = 0;
    double share = t < objects ? covered(numbers, state, f, t, &axis) : 1;
    double behind = t < objects ? pressed_behind(numbers, state, pair, pairs, f, t) : 0;
    const double* faces = numbers->spread + (1 + 2 * AXES) * pair[i];
    resistance[i] += rippled(numbers, touch, numbers->ripples[(int)faces[0]] + numbers->ripples[(int)faces[1 + axis]]);
    if (!spread(numbers, pair[i], touch, axis, share, behind, own + i * rates, root)) continue;
    for (int k = 0; k < rates; k++) {
      double part = work->grown[k] / numbers->dt; /* of a state that fades, over the step */
      difference[i] -= root[k] * part * states[k];
      resistance[i] += root[k] * root[k] * (1 - part) / numbers->decay[k];
    }
  }
  double drawn[tips];
  for (int f = 0; f < tips; f++) drawn[f] = backs[f].moves != 0 ? -row(numbers, numbers->tip_element, f, field(numbers, state, objects + f)) : 0;
  if (!has_room(work, (size_t)pairs * numbers->patterns)) return false;
  heat_share_faces(numbers, work, state, pairs, pair, own, roots, resistance, difference, order, members, lower, mutual);
  step(numbers, work, state, pairs, sides, resistance, difference, order, members, mutual, through);
  for (int i = 0; i < tips * targets; i++)
    for (int k = 0; k < rates; k++) state->narrow[i * rates + k] *= work->kept[k];
  for (int i = 0; i < pairs; i++)
    for (int k = 0; k < rates; k++)
      state->narrow[pair[i] * rates + k] += work->grown[k] * roots[i * rates + k] * through[i];
  for (int i = 0; i < pairs; i++)
    for (int b = 0; b < order[i]; b++)
      for (int k = 0; k < rates; k++)
        state->narrow[pair[members[i * SHARED + b]] * rates + k] += work->grown[k] * lower[(i * SHARED + b) * rates + k] * through[i];
  for (int f = 0; f < tips; f++) {
    double *x = field(numbers, state, objects + f), drop = row(numbers, numbers->tip_drop, f, x), force = 0;
    double* at = state->backs + f * (CHAIN + numbers->links);
    at[VOLTAGE] = numbers->seebeck[f] * drop;
    if (backs[f].moves != 0) {
      drawn[f] = (drawn[f] + row(numbers, numbers->tip_element, f, x)) / numbers->dt;
      for (int i = 0; i < pairs; i++)
        drawn[f] += through[i] * ((pair[i] / targets == f) - (pair[i] % targets == objects + f));
      for (int t = 0; t < targets; t++) force += state->touches[(f * targets + t) * COLUMNS + FORCE];
      for (int g = 0; g < tips; g++) force += state->touches[(g * targets + objects + f) * COLUMNS + FORCE];
      heat_behind(numbers, f, drawn[f], force / numbers->sample_steps, drop, at, x);
    }
  }
  return true;
}
