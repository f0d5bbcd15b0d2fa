/* A sample of heat: the fields that closed contacts join take one rational step of the exponential together;
touch/heat/systems.py, narrow.py and march.py, thermal/network/coupling.py and kernel.py. Groups that share no field are
told apart by the zeros between them. */

#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "heat.h"

#define MOST 1e100 /* K/W, of a contact */

/* What a closed contact sees of its target or of its fingertip: a port for each of its patterns, `sign` of it. */
typedef struct {
  int field, place, n, stride;
  double sign;
  const double *ports, *scale;
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

/* Of the pairs of poles, the real and imaginary parts in turn. */
static double complex at_pole(const double* parts, int q) { return CMPLX(parts[2 * q], parts[2 * q + 1]); }

/* Of finite numbers: C's own takes care of others. */
static double complex times(double complex a, double complex b) {
  return CMPLX(creal(a) * creal(b) - cimag(a) * cimag(b), creal(a) * cimag(b) + cimag(a) * creal(b));
}

static double complex inverse_of(double complex a) {
  double square = creal(a) * creal(a) + cimag(a) * cimag(a);
  return CMPLX(creal(a) / square, -cimag(a) / square);
}

/* How all ports of a network hear one another. */
static void hear(const Numbers* numbers, const Network* network) {
  int n = network->n, wide = network->count * numbers->patterns;
  for (int p = 0; p < wide; p++) {
    for (int r = 0; r <= p; r++) {
      const double *port = network->ports + (size_t)p * network->stride, *heard = network->ports + (size_t)r * network->stride;
      double sums[2 * POLES] = {0};
      for (int k = 0; k < n; k++)
        for (int q = 0; q < 2 * POLES; q++) sums[q] += port[k] * heard[k] * network->scale[q * n + k];
      for (int q = 0; q < POLES; q++)
        network->gram[(p * wide + r) * POLES + q] = network->gram[(r * wide + p) * POLES + q] = at_pole(sums, q);
    }
  }
}

/* What a network's step needs besides its ports. */
void heat_pace(const Numbers* numbers, Network* network) {
  int n = network->n;
  for (int i = 0; i < n; i++) {
    double rate = numbers->dt * network->rates[i], at_once = 0;
    for (int q = 0; q < POLES; q++) {
      double complex scale = inverse_of(at_pole(numbers->poles, q) + rate);
      network->scale[2 * q * n + i] = creal(scale);
      network->scale[(2 * q + 1) * n + i] = cimag(scale);
      at_once += creal(times(at_pole(numbers->weights, q), scale));
    }
    network->kept[i] = 1 + 2 * rate * at_once;
    network->fade[i] = exp(-rate);
  }
  hear(numbers, network);
}

/* Room for a step of m ports. Returns false where there is no memory. */
static bool has_room(Work* work, size_t m) {
  if (m <= work->ports && work->matrix) return true;
  free(work->matrix);
  work->matrix = malloc(sizeof(double complex) * (POLES * (m + 1) * m + 1)); /* never empty */
  work->ports = work->matrix ? m : 0;
  return work->matrix;
}

/* dt times how the closed contacts' ports hear one another, the lower half of (m, m) at every pole. */
static void join(const Numbers* numbers, const Work* work, const Side* sides, int pairs) {
  int patterns = numbers->patterns, m = pairs * patterns;
  memset(work->matrix, 0, sizeof(double complex) * POLES * m * m);
  for (int one = 0; one < 2 * pairs; one++) {
    for (int other = 0; other < 2 * (one / 2 + 1); other++) {
      const Side *own = sides + one, *theirs = sides + other;
      if (own->field != theirs->field) continue;
      const Network* network = work->networks + own->field;
      int wide = network->count * patterns;
      double sign = numbers->dt * own->sign * theirs->sign;
      for (int p = 0; p < patterns; p++) {
        const double complex* heard =
            network->gram + ((size_t)(own->place * patterns + p) * wide + theirs->place * patterns) * POLES;
        double complex* at = work->matrix + ((size_t)(one / 2 * patterns + p) * m + other / 2 * patterns) * POLES;
        for (int r = 0; r < patterns * POLES; r++) at[r] += sign * heard[r];
      }
    }
  }
}

/* Solves a symmetric matrix (m, m) at every pole, of which the lower half counts and is lost; no pivots, as they are never
small (thermal/batch/step.py). Poles come last: each waits for itself alone. */
static void solve(int m, double complex* matrix, double complex* x) {
#define AT(r, c) matrix[((r) * m + (c)) * POLES + q]
  double complex factor[POLES];
  for (int c = 0; c < m; c++) {
    for (int q = 0; q < POLES; q++) AT(c, c) = inverse_of(AT(c, c));
    for (int r = c + 1; r < m; r++) {
      bool apart = true;
      for (int q = 0; q < POLES; q++) {
        factor[q] = times(AT(r, c), AT(c, c));
        apart = apart && factor[q] == 0;
      }
      if (apart) continue;
      for (int k = c + 1; k <= r; k++)
        for (int q = 0; q < POLES; q++) AT(r, k) -= times(factor[q], AT(k, c));
      for (int q = 0; q < POLES; q++) x[r * POLES + q] -= times(factor[q], x[c * POLES + q]);
    }
  }
  for (int c = m - 1; c >= 0; c--) {
    for (int r = c + 1; r < m; r++)
      for (int q = 0; q < POLES; q++) x[c * POLES + q] -= times(AT(r, c), x[r * POLES + q]);
    for (int q = 0; q < POLES; q++) x[c * POLES + q] = times(x[c * POLES + q], AT(c, c));
  }
#undef AT
}

/* A step of every field; of each closed contact its sides, resistance K/W and difference K. through: its mean flow W. */
static void step(const Numbers* numbers, const Work* work, const State* state, int pairs, const Side* sides,
                 const double* resistance, const double* difference, double* through) {
  int patterns = numbers->patterns, m = pairs * patterns;
  double complex *matrix = work->matrix, *flow = matrix + (size_t)POLES * m * m;
  for (int i = 0, j = 0; i < pairs; i++) {
    for (int p = 0; p < patterns; p++, j++) {
      double heard[2 * POLES] = {0};
      for (const Side* side = sides + 2 * i; side < sides + 2 * i + 2; side++) {
        const double *restrict port = side->ports + p * side->stride, *restrict scale = side->scale;
        for (int k = 0; k < side->n; k++) {
          double seen = side->sign * port[k] * side->x[k];
          for (int q = 0; q < 2 * POLES; q++) heard[q] += seen * scale[q * side->n + k];
        }
      }
      for (int q = 0; q < POLES; q++)
        flow[j * POLES + q] = (p ? 0 : difference[i]) - times(at_pole(numbers->poles, q), at_pole(heard, q));
    }
  }
  join(numbers, work, sides, pairs);
  for (int j = 0; j < m; j++)
    for (int q = 0; q < POLES; q++) matrix[(j * m + j) * POLES + q] += resistance[j / patterns];
  solve(m, matrix, flow);
  memset(through, 0, sizeof(double) * pairs);
  for (int q = 0; q < POLES; q++) {
    double complex weight = 2 * at_pole(numbers->weights, q), lag = times(weight, inverse_of(at_pole(numbers->poles, q)));
    for (int i = 0; i < pairs; i++) through[i] -= creal(times(lag, flow[i * patterns * POLES + q]));
    for (int j = 0; j < m; j++) flow[j * POLES + q] = numbers->dt * times(weight, flow[j * POLES + q]);
  }
  for (int t = 0; t < numbers->targets; t++) {
    const Network* network = work->networks + t;
    double *x = field(numbers, state, t), *left = network->fade;
    for (int i = 0; i < 2 * pairs; i++)
      if (sides[i].field == t) left = network->kept;
    for (int k = 0; k < network->n; k++) x[k] *= left[k];
  }
  for (int i = 0, j = 0; i < pairs; i++) {
    for (int p = 0; p < patterns; p++, j++) {
      for (const Side* side = sides + 2 * i; side < sides + 2 * i + 2; side++) {
        const double *restrict port = side->ports + p * side->stride, *restrict scale = side->scale;
        double given[2 * POLES];
        for (int q = 0; q < POLES; q++) {
          given[2 * q] = side->sign * creal(flow[j * POLES + q]);
          given[2 * q + 1] = -side->sign * cimag(flow[j * POLES + q]);
        }
        for (int k = 0; k < side->n; k++) {
          double sum = 0;
          for (int q = 0; q < 2 * POLES; q++) sum += scale[q * side->n + k] * given[q];
          side->x[k] -= port[k] * sum;
        }
      }
    }
  }
}

/* Fills root with the b_k of a narrow contact; false where it is as wide as the face. */
static bool spread(const Numbers* numbers, int pair, const double* touch, double* root) {
  if (!(touch[AREA] > 0)) return false;
  double width = numbers->pads[pair / numbers->targets * PAD + WIDTH], area = touch[AREA] / touch[CLOSED];
  double first = fmin(area / (touch[LENGTH] / touch[AREA]), width), second = area / first;
  double across = fmin(first, second), along = fmin(fmax(first, second), width);
  if (!(across > 0 && across < width * (1 - 1e-9))) return false; /* any number may have been written to the state */
  int rates = numbers->rates;
  double narrow = fmin(2 * log2(width / across), WIDTHS - 1);
  int at = (int)fmin(narrow, WIDTHS - 2);
  double of_squares = exp2(narrow - at) - 1, of_strips = (exp2((narrow - at) / 2) - 1) / (sqrt(2) - 1);
  double square = fmin((width / along - 1) / (exp2(narrow / 2) - 1), 1);
  const double *one = numbers->narrow + ((size_t)pair * 2 * WIDTHS + at) * rates, *other = one + WIDTHS * rates;
  for (int k = 0; k < rates; k++) {
    double of_square = one[k] + of_squares * (one[rates + k] - one[k]);
    double of_strip = other[k] + of_strips * (other[rates + k] - other[k]);
    root[k] = sqrt(square * of_square + (1 - square) * of_strip);
  }
  return true;
}

/* Advances every field by a sample. Returns false where there is no memory. */
bool heat_march(const Numbers* numbers, Work* work, State* state) {
  int tips = numbers->tips, objects = numbers->objects, targets = numbers->targets, rates = numbers->rates, pairs = 0;
  int pair[tips * targets];
  for (int i = 0; i < tips * targets; i++)
    if (state->touches[i * COLUMNS + CONDUCTANCE] > 0) pair[pairs++] = i;
  Side sides[2 * pairs + 1]; /* never empty */
  double resistance[pairs + 1], difference[pairs + 1], through[pairs + 1], roots[pairs * rates + 1];
  memset(roots, 0, sizeof roots);
  for (int i = 0; i < pairs; i++) {
    int f = pair[i] / targets, t = pair[i] % targets;
    const double *touch = state->touches + pair[i] * COLUMNS, *own = state->narrow + pair[i] * rates;
    double* root = roots + i * rates;
    sides[2 * i] = side_of(numbers, work, state, t, t < objects ? (int)state->current[f * objects + t] : 0, 1);
    sides[2 * i + 1] = side_of(numbers, work, state, objects + f, 0, -1);
    resistance[i] = fmin(numbers->sample_steps / touch[CONDUCTANCE], MOST);
    difference[i] = numbers->warm[f] - (t >= objects ? numbers->warm[t - objects] : 0);
    if (!spread(numbers, pair[i], touch, root)) continue;
    for (int k = 0; k < rates; k++) {
      double part = work->grown[k] / numbers->dt; /* of a state that fades, over the step */
      difference[i] -= root[k] * part * own[k];
      resistance[i] += root[k] * root[k] * (1 - part) / numbers->decay[k];
    }
  }
  if (!has_room(work, (size_t)pairs * numbers->patterns)) return false;
  step(numbers, work, state, pairs, sides, resistance, difference, through);
  for (int i = 0; i < tips * targets; i++)
    for (int k = 0; k < rates; k++) state->narrow[i * rates + k] *= work->kept[k];
  for (int i = 0; i < pairs; i++)
    for (int k = 0; k < rates; k++)
      state->narrow[pair[i] * rates + k] += work->grown[k] * roots[i * rates + k] * through[i];
  for (int f = 0; f < tips; f++) {
    const double *x = field(numbers, state, objects + f), *row = numbers->tip_drop + f * numbers->tip_states;
    state->voltages[f] = 0;
    for (int k = 0; k < numbers->tip_states; k++) state->voltages[f] += numbers->seebeck[f] * row[k] * x[k];
  }
  return true;
}
