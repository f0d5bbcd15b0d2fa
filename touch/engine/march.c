/* A sample of heat: closed contacts join fields, which take one rational step of the exponential together;
touch/heat/systems.py, narrow.py and march.py, thermal/network/coupling.py and kernel.py. Groups that share no field are
told apart by the zeros between them. */

#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "heat.h"

static double* field(const Numbers* numbers, const State* state, int t) {
  int objects = numbers->objects;
  return t < objects ? state->x + t * numbers->states
                     : state->x + objects * numbers->states + (t - objects) * numbers->tip_states;
}

static int states_of(const Numbers* numbers, const Work* work, int t) {
  return t < numbers->objects ? work->networks[t].n : numbers->tip_states;
}

/* Of the pairs of poles, the real and imaginary parts in turn. */
static double complex at_pole(const double* parts, int q) { return CMPLX(parts[2 * q], parts[2 * q + 1]); }

/* How many numbers a system has, and its parts where they begin at `at`. */
static size_t lay_out(System* system, int ports, double* at) {
  size_t n = system->n, m = ports, square = 2 * m * m; /* of complex numbers */
  if (at) {
    system->gram = (double complex*)at;
    system->matrix = system->gram + POLES * m * m;
    system->heard = system->matrix + m * m;
    system->rates = (double*)(system->heard + POLES * m);
    system->ports = system->rates + n;
    system->scale = system->ports + n * m;
    system->weighed = system->scale + 2 * POLES * n;
    system->x = system->weighed + (2 * POLES + 1) * n;
    system->room = system->x + n;
  }
  return (POLES + 1) * square + 2 * POLES * m + n * (1 + m + 4 * POLES + 1 + 1) + n * (2 + 2 * POLES) + 2 * m;
}

/* What the system's step needs. */
static void assemble(const Numbers* numbers, const Work* work, const State* state, System* system) {
  int patterns = numbers->patterns, ports = system->pairs * patterns, n = system->n;
  int objects = numbers->objects, tip_states = numbers->tip_states;
  for (int t = 0; t < numbers->targets; t++) {
    if (system->begin[t] < 0) continue;
    const double* rates =
        t < objects ? work->networks[t].rates : numbers->tip_rates + (size_t)(t - objects) * tip_states;
    memcpy(system->rates + system->begin[t], rates, sizeof(double) * states_of(numbers, work, t));
  }
  memset(system->ports, 0, sizeof(double) * n * ports);
  for (int i = 0; i < system->pairs; i++) {
    int f = system->pair[2 * i], t = system->pair[2 * i + 1], *seen = system->seen + 4 * i;
    seen[0] = system->begin[t];
    seen[1] = seen[0] + states_of(numbers, work, t);
    seen[2] = system->begin[objects + f];
    seen[3] = seen[2] + tip_states;
    for (int p = 0; p < patterns; p++) {
      double* row = system->ports + (size_t)(i * patterns + p) * n;
      const double* given = numbers->tip_ports + (size_t)(f * patterns + p) * tip_states;
      const double* taking =
          t < objects
              ? work->networks[t].ports + ((size_t)state->current[f * objects + t] * patterns + p) * numbers->states
              : numbers->tip_ports + (size_t)((t - objects) * patterns + p) * tip_states;
      for (int k = 0; k < tip_states; k++) row[seen[2] + k] = -given[k];
      memcpy(row + seen[0], taking, sizeof(double) * (seen[1] - seen[0]));
    }
  }
  double* at_once = system->weighed + 2 * POLES * n;
  memset(at_once, 0, sizeof(double) * n);
  for (int q = 0; q < POLES; q++) {
    double *real = system->scale + 2 * q * n, *imag = real + n, *of_real = system->weighed + 2 * q * n;
    for (int k = 0; k < n; k++) {
      double complex scale = 1 / (at_pole(numbers->poles, q) + numbers->dt * system->rates[k]);
      double complex weighed = at_pole(numbers->weights, q) * scale;
      real[k] = creal(scale);
      imag[k] = cimag(scale);
      of_real[k] = creal(weighed);
      of_real[n + k] = -cimag(weighed);
      at_once[k] += creal(weighed);
    }
    for (int i = 0; i < ports; i++) {
      for (int j = 0; j <= i; j++) {
        const double *one = system->ports + (size_t)i * n, *other = system->ports + (size_t)j * n;
        double both_real = 0, both_imag = 0;
        for (int k = 0; k < n; k++) {
          double both = one[k] * other[k];
          both_real += both * real[k];
          both_imag += both * imag[k];
        }
        double complex* gram = system->gram + (size_t)q * ports * ports;
        gram[i * ports + j] = gram[j * ports + i] = CMPLX(both_real, both_imag);
      }
    }
  }
}

/* The system of the contacts that are closed now. Returns false where there is no memory. */
static bool join(const Numbers* numbers, Work* work, const State* state, const bool* closed) {
  int targets = numbers->targets, pairs = 0;
  System* system = &work->system;
  for (int t = 0; t < targets; t++) system->begin[t] = -1;
  for (int i = 0; i < numbers->tips * targets; i++) {
    if (!closed[i]) continue;
    system->pair[2 * pairs] = i / targets;
    system->pair[2 * pairs++ + 1] = i % targets;
    system->begin[i % targets] = system->begin[numbers->objects + i / targets] = 0;
  }
  system->n = 0;
  for (int t = 0; t < targets; t++) {
    if (system->begin[t] < 0) continue;
    system->begin[t] = system->n;
    system->n += states_of(numbers, work, t);
  }
  system->pairs = pairs ? -1 : 0;
  if (!pairs) return true;
  size_t size = lay_out(system, pairs * numbers->patterns, NULL);
  if (size > work->pool_size) {
    free(work->pool);
    work->pool_size = 0;
    if (!(work->pool = malloc(sizeof(double) * size))) return false;
    work->pool_size = size;
  }
  system->pairs = pairs;
  lay_out(system, pairs * numbers->patterns, work->pool);
  assemble(numbers, work, state, system);
  return true;
}

/* One step of the system's states; conductance W/K and difference K of each port. Returns its mean flow W. Of a port, only
the states that it sees are gone through: its target's and its fingertip's. */
static const double* step(const Numbers* numbers, const System* system, const double* conductance,
                          const double* difference) {
  int n = system->n, patterns = numbers->patterns, m = system->pairs * patterns;
  double *restrict state = system->x, *restrict rate = system->room, *restrict change = rate + n;
  double *restrict scaled = change + n, *flow = scaled + 2 * POLES * n, *through = flow + m;
  const double* at_once = system->weighed + 2 * POLES * n;
  for (int i = 0; i < n; i++) {
    rate[i] = -system->rates[i] * state[i];
    change[i] = at_once[i] * rate[i];
  }
  for (int k = 0; k < 2 * POLES; k++)
    for (int i = 0; i < n; i++) scaled[k * n + i] = rate[i] * system->scale[k * n + i];
  for (int j = 0; j < m; j++) {
    const double* restrict port = system->ports + (size_t)j * n;
    const int* seen = system->seen + 4 * (j / patterns);
    double now = 0, later[2 * POLES] = {0};
    for (int part = 0; part < 4; part += 2) {
      for (int i = seen[part]; i < seen[part + 1]; i++) {
        now += port[i] * state[i];
        for (int k = 0; k < 2 * POLES; k++) later[k] += port[i] * scaled[k * n + i];
      }
    }
    flow[j] = conductance[j] * (difference[j] - now);
    through[j] = 0;
    for (int q = 0; q < POLES; q++) system->heard[q * m + j] = at_pole(later, q);
  }
  for (int q = 0; q < POLES; q++) {
    const double complex *gram = system->gram + (size_t)q * m * m;
    double complex lag = at_pole(numbers->weights, q) / at_pole(numbers->poles, q);
    double complex *gathered = system->heard + q * m, *matrix = system->matrix;
    for (int j = 0; j < m; j++) {
      double weight = numbers->dt * conductance[j];
      gathered[j] = flow[j] - weight * gathered[j];
      for (int k = 0; k < m; k++) matrix[j * m + k] = weight * gram[j * m + k];
      matrix[j * m + j] += 1;
    }
    /* elimination without pivots, as they are never small (thermal/batch/step.py) */
    for (int c = 0; c < m; c++) {
      double complex inverse = matrix[c * m + c] = 1 / matrix[c * m + c];
      for (int r = c + 1; r < m; r++) {
        double complex factor = matrix[r * m + c] * inverse;
        if (factor == 0) continue;
        for (int k = c + 1; k < m; k++) matrix[r * m + k] -= factor * matrix[c * m + k];
        gathered[r] -= factor * gathered[c];
      }
    }
    for (int j = m - 1; j >= 0; j--) {
      for (int k = j + 1; k < m; k++) gathered[j] -= matrix[j * m + k] * gathered[k];
      gathered[j] *= matrix[j * m + j];
      through[j] -= 2 * creal(lag * gathered[j]);
    }
  }
  for (int j = 0; j < m; j++) {
    const double *restrict port = system->ports + (size_t)j * n, *restrict weighed = system->weighed;
    const int* seen = system->seen + 4 * (j / patterns);
    double total[2 * POLES];
    for (int q = 0; q < POLES; q++) {
      total[2 * q] = creal(system->heard[q * m + j]);
      total[2 * q + 1] = cimag(system->heard[q * m + j]);
    }
    for (int part = 0; part < 4; part += 2) {
      for (int i = seen[part]; i < seen[part + 1]; i++) {
        double sum = 0;
        for (int k = 0; k < 2 * POLES; k++) sum += weighed[k * n + i] * total[k];
        change[i] += port[i] * sum;
      }
    }
  }
  for (int i = 0; i < n; i++) state[i] -= 2 * numbers->dt * change[i];
  return through;
}

/* Fills root with the b_k of a narrow contact; false where it is as wide as the face. */
static bool spread(const Numbers* numbers, int pair, const double* touch, double* root) {
  if (!(touch[AREA] > 0)) return false;
  double width = numbers->pads[pair / numbers->targets * PAD + WIDTH], area = touch[AREA] / touch[CLOSED];
  double first = fmin(area / (touch[LENGTH] / touch[AREA]), width), second = area / first;
  double across = fmin(first, second), along = fmin(fmax(first, second), width);
  if (!(across < width * (1 - 1e-9))) return false;
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
  int tips = numbers->tips, objects = numbers->objects, targets = numbers->targets, patterns = numbers->patterns;
  System* system = &work->system;
  bool closed[tips * targets], same = system->pairs >= 0;
  for (int i = 0; i < tips * targets; i++) {
    closed[i] = state->touches[i * COLUMNS + CONDUCTANCE] > 0;
    same = same && closed[i] == work->closed[i];
  }
  if (!same || memcmp(work->current, state->current, sizeof(double) * tips * objects)) {
    if (!join(numbers, work, state, closed)) return false;
    memcpy(work->closed, closed, sizeof closed);
    memcpy(work->current, state->current, sizeof(double) * tips * objects);
  }
  int rates = numbers->rates, pairs = system->pairs;
  const double *kept = work->kept, *grown = work->grown;
  for (int i = 0; i < tips * targets; i++)
    for (int k = 0; k < rates && !closed[i]; k++) state->narrow[i * rates + k] *= kept[k];
  for (int t = 0; t < targets; t++) {
    const double* fade = t < objects ? work->networks[t].fade : work->fade + (t - objects) * numbers->tip_states;
    double* x = field(numbers, state, t);
    int size = states_of(numbers, work, t);
    if (system->begin[t] >= 0) memcpy(system->x + system->begin[t], x, sizeof(double) * size);
    else for (int k = 0; k < size; k++) x[k] *= fade[k];
  }
  if (!pairs) return true;
  double conductance[pairs * patterns], difference[pairs * patterns], roots[pairs * rates];
  memset(difference, 0, sizeof difference);
  memset(roots, 0, sizeof roots);
  for (int i = 0; i < pairs; i++) {
    int f = system->pair[2 * i], t = system->pair[2 * i + 1], pair = f * targets + t;
    const double* touch = state->touches + pair * COLUMNS;
    double mean = touch[CONDUCTANCE] / numbers->sample_steps, behind = 0, resists = 0, *root = roots + i * rates;
    if (spread(numbers, pair, touch, root)) {
      for (int k = 0; k < rates; k++) {
        double part = grown[k] / numbers->dt; /* of a state that fades, over the step */
        behind += root[k] * part * state->narrow[pair * rates + k];
        resists += root[k] * root[k] * (1 - part) / numbers->decay[k];
      }
      mean = 1 / (1 / mean + resists);
    }
    for (int k = 0; k < patterns; k++) conductance[i * patterns + k] = mean;
    difference[i * patterns] = numbers->warm[f] - (t >= objects ? numbers->warm[t - objects] : 0) - behind;
  }
  const double* through = step(numbers, system, conductance, difference);
  for (int i = 0; i < pairs; i++) {
    double* own = state->narrow + (system->pair[2 * i] * targets + system->pair[2 * i + 1]) * rates;
    for (int k = 0; k < rates; k++)
      own[k] = kept[k] * own[k] + grown[k] * roots[i * rates + k] * through[i * patterns];
  }
  for (int t = 0; t < targets; t++)
    if (system->begin[t] >= 0)
      memcpy(field(numbers, state, t), system->x + system->begin[t], sizeof(double) * states_of(numbers, work, t));
  return true;
}

/* V of a fingertip's sensor. */
double heat_voltage(const Numbers* numbers, const State* state, int tip) {
  const double *x = field(numbers, state, numbers->objects + tip), *row = numbers->tip_drop + tip * numbers->tip_states;
  double drop = 0;
  for (int k = 0; k < numbers->tip_states; k++) drop += row[k] * x[k];
  return drop * numbers->seebeck[tip];
}
