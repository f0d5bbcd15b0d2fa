/* The network of a box that is seen through patches on its faces: the heat kernel between the patches' patterns as in
thermal/kernels/axis.py and box.py with adiabatic faces, and the passive network of fixed rates as in contact.py and
exponentials.py. */

#include <math.h>
#include <string.h>

#include "heat.h"

enum { MODES = 24, STEPS = 8 };
#define IN_AIR 0.5 /* of a sheet's faces, as touch/heat/places/bodies.py */
#define SWITCH 0.0075 /* diffusion length squared over length squared from which eigenfunctions serve */
#define REACH 6.0     /* diffusion lengths beyond which an image is below round-off */
#define PENALTY .0134 /* of leaving the cone, beside columns of unit length */
#define RIDGE 1e-5    /* of the first guess, without constraint */
#define CARRIED .4    /* of what it has outside the cone */
#define RELAXED 1.7
#define SETTLED 4e-4  /* change of any residue in a step from which on it is the last */

/* A patch along one axis: order 1 tangential, with the patterns' nodes; order 0 a point. waves: its overlaps with eigenfunctions. */
typedef struct {
  int order, which;
  double places[NODES], waves[FUNCTIONS][MODES];
} Along;

/* Products with normalised eigenfunctions. */
static void overlaps(const Numbers* numbers, double length, Along* along) {
  for (int m = 0; m < MODES; m++) {
    double phase = m * pi / 2, wave = 2 * phase / length, norm = length / 2, waved[NODES];
    if (m > 0) norm *= 1 + (1 - 2 * (m % 2)) * sin(wave * length) / (wave * length);
    else norm *= 2;
    int nodes = along->order ? NODES : 1, functions = along->order ? FUNCTIONS : 1;
    for (int k = 0; k < nodes; k++) {
      double x = along->places[k] - length / 2;
      if (!along->order) waved[k] = cos(wave * x - phase);
      else waved[k] = m > 0 ? sin(wave * x - phase) / wave : x;
    }
    for (int f = 0; f < functions; f++) {
      double total = 0;
      for (int k = 0; k < nodes; k++) total += (along->order ? numbers->jumps[f * NODES + k] : 1) * waved[k];
      along->waves[f][m] = total / sqrt(norm);
    }
  }
}

/* Antiderivative of that order of the free kernel at distance d, less what it becomes far off. scale: 2 sqrt(tau). */
static double beyond(double d, double side, double scale, int order) {
  double r = fabs(d) / scale;
  if (r > REACH) return 0;
  if (order == 0) return exp(-r * r) / (scale * sqrt(pi));
  if (order == 1) return -0.5 * side * erfc(r);
  return 0.5 * scale * (exp(-r * r) / sqrt(pi) - r * erfc(r));
}

static double unbounded(double d, double scale, int order) {
  double side = d >= 0 ? 1 : -1, far = beyond(d, side, scale, order);
  return order == 2 ? far + 0.5 * fabs(d) : order == 1 ? far + 0.5 * side : far;
}

static double images(double one, double other, int other_order, int order, double length, double scale) {
  double near = one - other, far = one + other;
  double value = unbounded(near, scale, order);
  return (other_order ? -value : value) + beyond(far, 1, scale, order) + beyond(far - 2 * length, -1, scale, order);
}

/* The axis's kernel between the functions of two patches. */
static void between(const Numbers* numbers, const Along* a, const Along* b, double length, double tau,
                    double out[FUNCTIONS][FUNCTIONS]) {
  int first = a->order ? FUNCTIONS : 1, second = b->order ? FUNCTIONS : 1;
  if (tau > SWITCH * length * length) {
    memset(out, 0, FUNCTIONS * FUNCTIONS * sizeof(double));
    for (int w = 0; w < MODES; w++) {
      double wave = w * pi / length, decay = exp(-wave * wave * tau);
      if (decay < 1e-17) return;
      for (int f = 0; f < first; f++)
        for (int g = 0; g < second; g++) out[f][g] += decay * a->waves[f][w] * b->waves[g][w];
    }
    return;
  }
  double table[NODES][NODES], scale = 2 * sqrt(tau);
  int rows = a->order ? NODES : 1, columns = b->order ? NODES : 1;
  for (int k = 0; k < rows; k++)
    for (int q = 0; q < columns; q++)
      table[k][q] = a == b && q > k ? 0 : images(a->places[k], b->places[q], b->order, a->order + b->order, length, scale);
  for (int k = 0; a == b && k < rows; k++)
    for (int q = k + 1; q < columns; q++) table[k][q] = table[q][k];
  for (int f = 0; f < first; f++) {
    double half[NODES];
    for (int q = 0; q < columns; q++) {
      half[q] = 0;
      for (int k = 0; k < rows; k++) half[q] += (a->order ? numbers->jumps[f * NODES + k] : 1) * table[k][q];
    }
    for (int g = 0; g < second; g++) {
      out[f][g] = 0;
      for (int q = 0; q < columns; q++) out[f][g] += (b->order ? numbers->jumps[g * NODES + q] : 1) * half[q];
    }
  }
}

static int function(const Numbers* numbers, const Along* along, int pattern) {
  return along->order ? (int)numbers->along[2 * pattern + along->which] : 0;
}

/* out (M, M) += scale * left^T table right, of two fingertips' bases (PATTERNS, M) */
static void project(int patterns, const double* left, double table[PATTERNS][PATTERNS], const double* right, double scale,
                    double* out, int stride) {
  for (int i = 0; i < PATTERNS; i++) {
    for (int q = 0; q < patterns; q++) {
      double half = 0;
      for (int j = 0; j < PATTERNS; j++) half += table[i][j] * right[j * patterns + q];
      for (int p = 0; p < patterns; p++) out[p * stride + q] += scale * left[i * patterns + p] * half;
    }
  }
}

/* What is kept of an object's last network: how many places, these, and rest of `impedance`. */
size_t heat_impedances(const Numbers* numbers) {
  size_t wide = (size_t)numbers->places * numbers->patterns;
  return 1 + numbers->places * SLOT + MOMENTS * wide * wide;
}

/* Which of them a place is, -1 for none. */
static int kept_at(const double* kept, const double* place) {
  for (int n = 0; n < (int)kept[0]; n++)
    if (!memcmp(kept + 1 + n * SLOT, place, PLACED * sizeof(double))) return n;
  return -1;
}

/* rest (MOMENTS, W, W) K/W between the patches' patterns, less the mean temperature's part, and its port (W,); what is
kept of it is taken from there, and kept for the next time */
static void impedance(const Numbers* numbers, int object, const Network* network, double* kept, double* port, double* rest,
                      double* room) {
  const double* box = numbers->boxes + object * BOX;
  int count = network->count, patterns = numbers->patterns, wide = count * patterns;
  double capacity = box[CAPACITY], area[count];
  Along* along = (Along*)room; /* (3, count) */
  memset(rest, 0, sizeof(double) * MOMENTS * wide * wide);
  for (int n = 0; n < count; n++) {
    const double* place = network->places + n * SLOT;
    int facing = (int)place[FACE] / 2, tip = (int)place[TIP];
    area[n] = 4;
    double seen[PATTERNS];
    for (int i = 0; i < PATTERNS; i++) seen[i] = 1;
    for (int axis = 0; axis < 3; axis++) {
      Along* patch = &along[axis * count + n];
      patch->order = axis != facing;
      patch->which = axis < facing ? axis : axis - 1;
      if (patch->order) {
        double half = lesser(sqrt(numbers->tip_area[tip]), box[axis]) / 2;
        area[n] *= half;
        for (int k = 0; k < NODES; k++) patch->places[k] = place[MIDDLE + patch->which] + half * numbers->nodes[k];
      } else {
        patch->places[0] = box[axis] * ((int)place[FACE] % 2);
      }
      overlaps(numbers, box[axis], patch);
      for (int i = 0; i < PATTERNS; i++) seen[i] *= patch->waves[function(numbers, patch, i)][0];
    }
    for (int p = 0; p < patterns; p++) {
      double total = 0;
      for (int i = 0; i < PATTERNS; i++) total += numbers->tip_basis[(tip * PATTERNS + i) * patterns + p] * seen[i];
      port[n * patterns + p] = total / (area[n] * sqrt(capacity));
    }
  }
  for (int n = 0; n < count; n++) {
    const double* left = numbers->tip_basis + (size_t)network->places[n * SLOT + TIP] * PATTERNS * patterns;
    int row = kept_at(kept, network->places + n * SLOT), old = (int)kept[0] * patterns;
    bool alone = true;
    for (int m = 0; m <= n; m++) {
      int column = kept_at(kept, network->places + m * SLOT);
      if (row >= 0 && column >= 0 && column <= row) { /* summed in the same order */
        const double* from = kept + 1 + numbers->places * SLOT;
        for (int s = 0; s < MOMENTS; s++)
          for (int p = 0; p < patterns; p++)
            memcpy(rest + ((size_t)s * wide + n * patterns + p) * wide + m * patterns,
                   from + ((size_t)s * old + row * patterns + p) * old + column * patterns, sizeof(double) * patterns);
        alone = alone && m < n;
        continue;
      }
      const double* right = numbers->tip_basis + (size_t)network->places[m * SLOT + TIP] * PATTERNS * patterns;
      double block[patterns * patterns];
      for (int t = 0; t < TIMES; t++) {
        double kernels[3][FUNCTIONS][FUNCTIONS], table[PATTERNS][PATTERNS];
        for (int axis = 0; axis < 3; axis++)
          between(numbers, &along[axis * count + n], &along[axis * count + m], box[axis],
                  box[CONDUCTIVITY] / capacity * numbers->times[t], kernels[axis]);
        for (int i = 0; i < PATTERNS; i++) {
          for (int j = 0; j < PATTERNS; j++) {
            table[i][j] = 1;
            for (int axis = 0; axis < 3; axis++)
              table[i][j] *= kernels[axis][function(numbers, &along[axis * count + n], i)]
                                    [function(numbers, &along[axis * count + m], j)];
          }
        }
        for (int i = 0; i < patterns * patterns; i++)
          block[i] = -port[n * patterns + i / patterns] * port[m * patterns + i % patterns];
        project(patterns, left, table, right, 1 / (area[n] * area[m] * capacity), block, patterns);
        for (int s = 0; s < MOMENTS; s++)
          for (int i = 0; i < patterns * patterns; i++)
            rest[((size_t)s * wide + n * patterns + i / patterns) * wide + m * patterns + i % patterns] +=
                numbers->to_moments[s * TIMES + t] * block[i];
      }
    }
    if (!alone) continue;
    double even[PATTERNS][PATTERNS];
    memcpy(even, numbers->gram, sizeof even);
    for (int s = 0; s < MOMENTS; s++)
      project(patterns, left, even, left, box[EARLY] / area[n],
              rest + ((size_t)s * wide + n * patterns) * wide + n * patterns, wide);
  }
  for (int s = 0; s < MOMENTS; s++)
    for (int i = 0; i < wide; i++)
      for (int j = 0; j < i; j++) rest[((size_t)s * wide + j) * wide + i] = rest[((size_t)s * wide + i) * wide + j];
  kept[0] = count;
  memcpy(kept + 1, network->places, sizeof(double) * count * SLOT);
  memcpy(kept + 1 + numbers->places * SLOT, rest, sizeof(double) * MOMENTS * wide * wide);
}

/* The eigenvectors (W, W, K), in rows of `turn`, and the values on the diagonal of `moved` (W, W, K), as far as they are
above 0, of matrices whose sum with the columns (MOMENTS, K) is nearest to wanted (MOMENTS, W, W): positive semidefinite,
thermal/numerics/passive_residues.py. room: (4, W, W, K). */
static void residues(int rates, int wide, double* columns, const double* wanted, double* turn, double* moved, double* room) {
  int square = wide * wide;
  size_t whole = (size_t)rates * square;
  double *seen = room, *dual = seen + whole, *half = dual + whole, *inside = half + whole;
  double size[rates], normal[rates * rates], ridged[rates * rates], solve[rates * rates], guess[rates * rates];
  for (int k = 0; k < rates; k++) {
    size[k] = 0;
    for (int s = 0; s < MOMENTS; s++) size[k] += columns[s * rates + k] * columns[s * rates + k];
    size[k] = sqrt(size[k]);
    for (int s = 0; s < MOMENTS; s++) columns[s * rates + k] /= size[k];
  }
  mju_mulMatTMat(normal, columns, columns, MOMENTS, rates, rates);
  memcpy(ridged, normal, sizeof normal);
  for (int k = 0; k < rates; k++) {
    normal[k * rates + k] += PENALTY;
    ridged[k * rates + k] += RIDGE;
  }
  heat_inverse(rates, normal, solve);
  heat_inverse(rates, ridged, guess);
#define AT(what, i, j) (what + ((size_t)(i) * wide + (j)) * rates)
  memset(dual, 0, sizeof(double) * whole);
  memset(turn, 0, sizeof(double) * whole);
  mju_mulMatTMat(seen, wanted, columns, MOMENTS, square, rates);
  mju_mulMatMat(inside, seen, guess, square, rates, rates); /* symmetric, as solve is */
  for (int i = 0; i < wide; i++)
    for (int k = 0; k < rates; k++) AT(turn, i, i)[k] = 1;
  for (int step = 0; step < STEPS; step++) {
    for (int i = 0; i < wide; i++) {
      for (int j = 0; j <= i; j++) {
        double *residue = AT(inside, i, j), *left = AT(dual, i, j), *from = AT(seen, i, j), pulled[rates], free[rates];
        if (step) {
          for (int k = 0; k < rates; k++) pulled[k] = from[k] + PENALTY * (residue[k] - left[k]);
          mju_mulMatVec(free, solve, pulled, rates, rates);
          for (int k = 0; k < rates; k++) left[k] = RELAXED * free[k] + (1 - RELAXED) * residue[k] + left[k];
        } else {
          memcpy(left, residue, sizeof free);
        }
        memcpy(AT(dual, j, i), left, sizeof free);
      }
    }
    /* seen from the last step's eigenvectors it is nearly diagonal */
    memset(half, 0, sizeof(double) * whole);
    memset(moved, 0, sizeof(double) * whole);
    for (int m = 0; m < wide; m++)
      for (int i = 0; i < wide; i++)
        for (int r = 0; r < wide; r++)
          for (int k = 0; k < rates; k++) AT(half, m, i)[k] += AT(dual, i, r)[k] * AT(turn, m, r)[k];
    for (int i = 0; i < wide; i++)
      for (int j = 0; j <= i; j++)
        for (int m = 0; m < wide; m++)
          for (int k = 0; k < rates; k++) AT(moved, i, j)[k] += AT(turn, i, m)[k] * AT(half, j, m)[k];
    heat_diagonalise(wide, rates, moved, turn);
    for (int m = 0; m < wide; m++)
      for (int i = 0; i < wide; i++)
        for (int k = 0; k < rates; k++) AT(half, m, i)[k] = greater(AT(moved, m, m)[k], 0) * AT(turn, m, i)[k];
    double moving = 0;
    for (int i = 0; i < wide; i++) {
      for (int j = 0; j <= i; j++) {
        double *residue = AT(inside, i, j), next[rates];
        memset(next, 0, sizeof next);
        for (int m = 0; m < wide; m++)
          for (int k = 0; k < rates; k++) next[k] += AT(turn, m, i)[k] * AT(half, m, j)[k];
        for (int k = 0; k < rates; k++) {
          moving = greater(moving, fabs(next[k] - residue[k]));
          residue[k] = next[k];
          AT(dual, i, j)[k] = (step ? 1 : CARRIED) * (AT(dual, i, j)[k] - next[k]);
        }
        memcpy(AT(dual, j, i), AT(dual, i, j), sizeof(double) * rates);
      }
    }
    if (moving < SETTLED) break;
  }
  for (int m = 0; m < wide; m++)
    for (int k = 0; k < rates; k++) AT(moved, m, m)[k] /= size[k];
#undef AT
}

size_t heat_network_room(const Numbers* numbers) {
  size_t wide = (size_t)numbers->places * numbers->patterns, square = wide * wide;
  size_t along = 3 * (size_t)numbers->places * (sizeof(Along) / sizeof(double) + 1);
  return along + wide + MOMENTS * (square + 1 + numbers->rates) + 6 * numbers->rates * square;
}

void heat_copy_network(const Numbers* numbers, const Network* from, Network* to) {
  size_t size = from->ports - from->places + (size_t)numbers->states * numbers->places * numbers->patterns;
  to->count = from->count;
  to->n = from->n;
  memcpy(to->places, from->places, sizeof(double) * size);
}

/* The ports that a network has, by number: of a place all patterns, or the even one alone. Returns how many. */
int heat_used_ports(const Numbers* numbers, const Network* network, int* ports) {
  int few = 0;
  for (int n = 0; n < network->count; n++)
    for (int p = 0; p < numbers->patterns; p++)
      if (p == 0 || network->places[n * SLOT + ALL] != 0) ports[few++] = n * numbers->patterns + p;
  return few;
}

/* Makes the network of the places that stand in it. impedances: what is kept of the object's last one. */
void heat_network(const Numbers* numbers, int object, Network* network, double* impedances, double* room) {
  const double* box = numbers->boxes + object * BOX;
  int count = network->count, patterns = numbers->patterns, wide = count * patterns, rates = numbers->rates, used[wide + 1];
  size_t square = (size_t)wide * wide;
  double *port = room + 3 * (size_t)count * (sizeof(Along) / sizeof(double) + 1), *rest = port + wide;
  double *weight = rest + MOMENTS * square, *columns = weight + MOMENTS, *turn = columns + MOMENTS * rates;
  network->n = 1;
  network->rates[0] = box[LOSS];
  if (count) {
    impedance(numbers, object, network, impedances, port, rest, room);
    int few = heat_used_ports(numbers, network, used);
    for (int s = 0; s < MOMENTS; s++) {
      double moment = numbers->moments[s], most = INFINITY;
      for (int n = 0; n < count; n++) {
        double even = port[n * patterns];
        double admittance = 1 / numbers->tip_weight[(size_t)network->places[n * SLOT + TIP] * MOMENTS + s];
        admittance += rest[((size_t)s * wide + n * patterns) * wide + n * patterns] + even * even / moment;
        most = lesser(most, 1 / admittance);
      }
      weight[s] = most;
      for (int k = 0; k < rates; k++) columns[s * rates + k] = most / (moment + numbers->decay[k]);
    }
    for (int s = 0; s < MOMENTS; s++) /* in place: nothing is written where it is still to be read */
      for (int a = 0; a < few; a++)
        for (int b = 0; b < few; b++)
          rest[((size_t)s * few + a) * few + b] = rest[((size_t)s * wide + used[a]) * wide + used[b]] * weight[s];
    square = (size_t)few * few;
    double *values = turn + rates * square, least = numbers->least / weight[MOMENTS - 1];
    residues(rates, few, columns, rest, turn, values, values + rates * square);
    memset(network->ports, 0, sizeof(double) * wide * numbers->states);
    for (int j = 0; j < few; j++) network->ports[(size_t)used[j] * numbers->states] = port[used[j]];
    for (int k = 0; k < rates; k++) {
      for (int m = 0; m < few; m++) {
        double value = values[((size_t)m * few + m) * rates + k], left = value - pow(least * numbers->decay[k], 2) / value;
        if (!(value > 0 && left > 0)) continue;
        network->rates[network->n] = numbers->decay[k] + IN_AIR * box[LOSS] / (1 + numbers->decay[k] / box[CROSSING]);
        for (int j = 0; j < few; j++)
          network->ports[(size_t)used[j] * numbers->states + network->n] = turn[((size_t)m * few + j) * rates + k] * sqrt(left);
        network->n++;
      }
    }
  }
  heat_pace(numbers, network, false);
}
