/* A sample of heat: closed contacts join fields into groups, each of which takes one rational step of the exponential;
touch/heat/systems.py, narrow.py and march.py, thermal/network/coupling.py and kernel.py. */

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

/* How many numbers a group has, and its parts where they begin at `at`. */
static size_t lay_out(Group* group, int ports, double* at) {
  size_t n = group->n, m = ports;
  if (at) {
    group->rates = at;
    group->ports = group->rates + n;
    group->scale = group->ports + n * m;
    group->weighed = group->scale + 2 * POLES * n;
    group->gram = group->weighed + (2 * POLES + 1) * n;
    group->room = group->gram + 2 * POLES * m * m;
  }
  return n * (1 + m + 4 * POLES + 1 + 3 + 2 * POLES) + 2 * POLES * m * m + m * (2 + 2 * POLES) + 2 * m * m;
}

/* What a group's step needs: of its fields behind one another. */
static void assemble(const Numbers* numbers, const Work* work, const State* state, Group* group) {
  int patterns = numbers->patterns, ports = group->pairs * patterns, begin[numbers->targets];
  int objects = numbers->objects, tip_states = numbers->tip_states;
  group->n = 0;
  for (int i = 0; i < group->members; i++) {
    int t = group->member[i];
    begin[t] = group->n;
    const double* rates =
        t < objects ? work->networks[t].rates : numbers->tip_rates + (size_t)(t - objects) * tip_states;
    memcpy(group->rates + group->n, rates, sizeof(double) * states_of(numbers, work, t));
    group->n += states_of(numbers, work, t);
  }
  int n = group->n;
  memset(group->ports, 0, sizeof(double) * n * ports);
  for (int i = 0; i < group->pairs; i++) {
    int f = group->pair[2 * i], t = group->pair[2 * i + 1], *seen = group->seen + 4 * i;
    seen[0] = begin[t];
    seen[1] = begin[t] + states_of(numbers, work, t);
    seen[2] = begin[objects + f];
    seen[3] = begin[objects + f] + tip_states;
    for (int p = 0; p < patterns; p++) {
      double* row = group->ports + (size_t)(i * patterns + p) * n;
      const double* given = numbers->tip_ports + (size_t)(f * patterns + p) * tip_states;
      for (int k = 0; k < tip_states; k++) row[begin[objects + f] + k] = -given[k];
      if (t < objects) {
        int place = (int)state->current[f * objects + t];
        const double* taking = work->networks[t].ports + (size_t)(place * patterns + p) * numbers->states;
        memcpy(row + begin[t], taking, sizeof(double) * work->networks[t].n);
      } else {
        const double* taking = numbers->tip_ports + (size_t)((t - objects) * patterns + p) * tip_states;
        memcpy(row + begin[t], taking, sizeof(double) * tip_states);
      }
    }
  }
  double* at_once = group->weighed + 2 * POLES * n;
  memset(at_once, 0, sizeof(double) * n);
  for (int q = 0; q < POLES; q++) {
    double re = numbers->poles[2 * q], im = numbers->poles[2 * q + 1];
    double weight_real = numbers->weights[2 * q], weight_imag = numbers->weights[2 * q + 1];
    double *real = group->scale + 2 * q * n, *imag = real + n, *gram = group->gram + (size_t)2 * q * ports * ports;
    double *of_real = group->weighed + 2 * q * n, *of_imag = of_real + n;
    for (int k = 0; k < n; k++) {
      double along = re + numbers->dt * group->rates[k], size = 1 / (along * along + im * im);
      real[k] = along * size;
      imag[k] = -im * size;
      of_real[k] = weight_real * real[k] - weight_imag * imag[k];
      of_imag[k] = -weight_real * imag[k] - weight_imag * real[k];
      at_once[k] += of_real[k];
    }
    for (int i = 0; i < ports; i++) {
      for (int j = 0; j < ports; j++) {
        double both_real = 0, both_imag = 0;
        for (int k = 0; k < n; k++) {
          double both = group->ports[(size_t)i * n + k] * group->ports[(size_t)j * n + k];
          both_real += both * real[k];
          both_imag += both * imag[k];
        }
        gram[2 * (i * ports + j)] = both_real;
        gram[2 * (i * ports + j) + 1] = both_imag;
      }
    }
  }
}

/* The groups of the contacts that are closed now. */
static bool join(const Numbers* numbers, Work* work, const State* state, const bool* closed) {
  int tips = numbers->tips, objects = numbers->objects, targets = numbers->targets, group_of[targets];
  for (int t = 0; t < targets; t++) group_of[t] = t;
  for (int i = 0; i < tips * targets; i++) {
    if (!closed[i]) continue;
    int one = group_of[objects + i / targets], other = group_of[i % targets];
    for (int t = 0; t < targets; t++)
      if (group_of[t] == one) group_of[t] = other;
  }
  size_t size = 0;
  int count = 0;
  work->count = -1;
  for (int leader = 0; leader < targets; leader++) {
    Group* group = &work->groups[count];
    group->n = 0;
    group->pairs = group->members = 0;
    for (int i = 0; i < tips * targets; i++) {
      if (!closed[i] || group_of[i % targets] != leader) continue;
      group->pair[2 * group->pairs] = i / targets;
      group->pair[2 * group->pairs++ + 1] = i % targets;
    }
    if (!group->pairs) continue;
    for (int t = 0; t < targets; t++) {
      if (group_of[t] != leader) continue;
      group->member[group->members++] = t;
      group->n += states_of(numbers, work, t);
    }
    size += lay_out(group, group->pairs * numbers->patterns, NULL);
    count++;
  }
  if (size > work->pool_size) {
    free(work->pool);
    work->pool_size = 0;
    if (!(work->pool = malloc(sizeof(double) * size))) return false;
    work->pool_size = size;
  }
  double* at = work->pool;
  for (int g = 0; g < count; g++) {
    at += lay_out(&work->groups[g], work->groups[g].pairs * numbers->patterns, at);
    assemble(numbers, work, state, &work->groups[g]);
  }
  work->count = count;
  return true;
}

/* One step of a group's states; conductance W/K and difference K of each port. Returns its mean flow W. Of a port, only
the states that it sees are gone through: its target's and its fingertip's. */
static const double* step(const Numbers* numbers, const Group* group, double* restrict state, const double* conductance,
                          const double* difference, double* restrict room) {
  int n = group->n, patterns = numbers->patterns, m = group->pairs * patterns;
  double *restrict rate = room, *restrict change = rate + n, *restrict scaled = change + n;
  double *flow = scaled + 2 * POLES * n, *through = flow + m, *heard = through + m, *matrix = heard + 2 * POLES * m;
  const double* at_once = group->weighed + 2 * POLES * n;
  for (int i = 0; i < n; i++) {
    rate[i] = -group->rates[i] * state[i];
    change[i] = at_once[i] * rate[i];
  }
  for (int k = 0; k < 2 * POLES; k++)
    for (int i = 0; i < n; i++) scaled[k * n + i] = rate[i] * group->scale[k * n + i];
  for (int j = 0; j < m; j++) {
    const double* restrict port = group->ports + (size_t)j * n;
    const int* seen = group->seen + 4 * (j / patterns);
    double now = 0, later[2 * POLES] = {0};
    for (int part = 0; part < 4; part += 2) {
      for (int i = seen[part]; i < seen[part + 1]; i++) {
        now += port[i] * state[i];
        for (int k = 0; k < 2 * POLES; k++) later[k] += port[i] * scaled[k * n + i];
      }
    }
    flow[j] = conductance[j] * (difference[j] - now);
    through[j] = 0;
    for (int k = 0; k < 2 * POLES; k++) heard[k / 2 * 2 * m + 2 * j + k % 2] = later[k];
  }
  for (int q = 0; q < POLES; q++) {
    const double* gram = group->gram + (size_t)2 * q * m * m;
    double weight_real = numbers->weights[2 * q], weight_imag = numbers->weights[2 * q + 1];
    double pole_real = numbers->poles[2 * q], pole_imag = numbers->poles[2 * q + 1];
    double size = pole_real * pole_real + pole_imag * pole_imag; /* lag: weight / pole */
    double lag_real = (weight_real * pole_real + weight_imag * pole_imag) / size;
    double lag_imag = (weight_imag * pole_real - weight_real * pole_imag) / size;
    double* gathered = heard + 2 * q * m;
    for (int j = 0; j < m; j++) {
      double weight = numbers->dt * conductance[j];
      gathered[2 * j] = flow[j] - weight * gathered[2 * j];
      gathered[2 * j + 1] = -weight * gathered[2 * j + 1];
      for (int k = 0; k < 2 * m; k++) matrix[2 * j * m + k] = weight * gram[2 * j * m + k];
      matrix[2 * (j * m + j)] += 1;
    }
    /* elimination without pivots, as they are never small (thermal/batch/step.py) */
    for (int c = 0; c < m; c++) {
      double* pivot = matrix + 2 * (c * m + c);
      double size = 1 / (pivot[0] * pivot[0] + pivot[1] * pivot[1]), re = pivot[0] * size, im = -pivot[1] * size;
      pivot[0] = re;
      pivot[1] = im;
      for (int r = c + 1; r < m; r++) {
        double *row = matrix + 2 * r * m, *top = matrix + 2 * c * m;
        double a = row[2 * c] * re - row[2 * c + 1] * im, b = row[2 * c] * im + row[2 * c + 1] * re;
        for (int k = c + 1; k < m; k++) {
          row[2 * k] -= a * top[2 * k] - b * top[2 * k + 1];
          row[2 * k + 1] -= a * top[2 * k + 1] + b * top[2 * k];
        }
        gathered[2 * r] -= a * gathered[2 * c] - b * gathered[2 * c + 1];
        gathered[2 * r + 1] -= a * gathered[2 * c + 1] + b * gathered[2 * c];
      }
    }
    for (int j = m - 1; j >= 0; j--) {
      const double* row = matrix + 2 * j * m;
      double a = gathered[2 * j], b = gathered[2 * j + 1];
      for (int k = j + 1; k < m; k++) {
        a -= row[2 * k] * gathered[2 * k] - row[2 * k + 1] * gathered[2 * k + 1];
        b -= row[2 * k] * gathered[2 * k + 1] + row[2 * k + 1] * gathered[2 * k];
      }
      double total_real = a * row[2 * j] - b * row[2 * j + 1], total_imag = a * row[2 * j + 1] + b * row[2 * j];
      gathered[2 * j] = total_real;
      gathered[2 * j + 1] = total_imag;
      through[j] -= 2 * (lag_real * total_real - lag_imag * total_imag);
    }
  }
  for (int j = 0; j < m; j++) {
    const double *restrict port = group->ports + (size_t)j * n, *restrict weighed = group->weighed;
    const int* seen = group->seen + 4 * (j / patterns);
    double total[2 * POLES];
    for (int k = 0; k < 2 * POLES; k++) total[k] = heard[k / 2 * 2 * m + 2 * j + k % 2];
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
  bool closed[tips * targets], busy[targets], same = work->count >= 0;
  for (int i = 0; i < tips * targets; i++) {
    closed[i] = state->touches[i * COLUMNS + CONDUCTANCE] > 0;
    same = same && closed[i] == (work->closed[i] != 0);
  }
  same = same && !memcmp(work->current, state->current, sizeof(double) * tips * objects);
  if (!same) {
    if (!join(numbers, work, state, closed)) return false;
    for (int i = 0; i < tips * targets; i++) work->closed[i] = closed[i];
    memcpy(work->current, state->current, sizeof(double) * tips * objects);
  }
  memset(busy, 0, sizeof busy);
  int rates = numbers->rates;
  const double *kept = work->kept, *grown = work->grown;
  for (int i = 0; i < tips * targets; i++)
    for (int k = 0; k < rates && !closed[i]; k++) state->narrow[i * rates + k] *= kept[k];
  for (int g = 0; g < work->count; g++) {
    const Group* group = &work->groups[g];
    double *x = group->room, conductance[group->pairs * patterns], difference[group->pairs * patterns];
    double roots[group->pairs * rates];
    for (int i = 0; i < group->members; i++) {
      int t = group->member[i], size = states_of(numbers, work, t);
      busy[t] = true;
      memcpy(x, field(numbers, state, t), sizeof(double) * size);
      x += size;
    }
    memset(difference, 0, sizeof difference);
    memset(roots, 0, sizeof roots);
    for (int i = 0; i < group->pairs; i++) {
      int f = group->pair[2 * i], t = group->pair[2 * i + 1], pair = f * targets + t;
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
    const double* through = step(numbers, group, group->room, conductance, difference, group->room + group->n);
    for (int i = 0; i < group->pairs; i++) {
      double* own = state->narrow + (group->pair[2 * i] * targets + group->pair[2 * i + 1]) * rates;
      for (int k = 0; k < rates; k++)
        own[k] = kept[k] * own[k] + grown[k] * roots[i * rates + k] * through[i * patterns];
    }
    x = group->room;
    for (int i = 0; i < group->members; i++) {
      int t = group->member[i], size = states_of(numbers, work, t);
      memcpy(field(numbers, state, t), x, sizeof(double) * size);
      x += size;
    }
  }
  for (int t = 0; t < targets; t++) {
    if (busy[t]) continue;
    const double* fade = t < objects ? work->networks[t].fade : work->fade + (t - objects) * numbers->tip_states;
    double* x = field(numbers, state, t);
    for (int k = 0; k < states_of(numbers, work, t); k++) x[k] *= fade[k];
  }
  return true;
}

/* V of a fingertip's sensor. */
double heat_voltage(const Numbers* numbers, const State* state, int tip) {
  const double *x = field(numbers, state, numbers->objects + tip), *row = numbers->tip_drop + tip * numbers->tip_states;
  double drop = 0;
  for (int k = 0; k < numbers->tip_states; k++) drop += row[k] * x[k];
  return drop * numbers->seebeck[tip];
}
