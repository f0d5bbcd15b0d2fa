/* Small dense matrices, row by row. */

#include <math.h>
#include <string.h>

#include "heat.h"

#define TINY 1e-300 /* beside a zero */
#define ROUND_OFF 1e-24 /* squares off the diagonal that may be left, beside those on it */

static void rotate(int count, double* restrict first, double* restrict second, const double* cosine, const double* sine) {
  for (int k = 0; k < count; k++) {
    double a = first[k], b = second[k];
    first[k] = cosine[k] * a - sine[k] * b;
    second[k] = sine[k] * a + cosine[k] * b;
  }
}

/* Cosines and sines of the rotations that make between 0, and the diagonal after them. */
static void angle(int count, double* first, double* second, double* between, double* cosine, double* sine) {
  for (int k = 0; k < count; k++) {
    double twice = 2 * between[k], difference = second[k] - first[k];
    double tangent = copysign(twice / (fabs(difference) + sqrt(difference * difference + twice * twice) + TINY), difference * twice);
    cosine[k] = 1 / sqrt(tangent * tangent + 1);
    sine[k] = tangent * cosine[k];
    first[k] -= tangent * between[k];
    second[k] += tangent * between[k];
    between[k] = 0;
  }
}

/* Turns `count` symmetric matrices (N, N, count) at once into their eigenvalues, and adds the rotations to the rows of
turn; of the matrices the lower halves count. As thermal/numerics/passive_residues.py does. */
void heat_diagonalise(int n, int count, double* matrix, double* turn) {
  double off[count], on[count], cosine[count], sine[count];
#define AT(what, i, j) (what + ((size_t)(i) * n + (j)) * count)
  for (int sweep = 0; sweep < 30; sweep++) {
    memset(off, 0, sizeof off);
    memset(on, 0, sizeof on);
    for (int i = 0; i < n; i++) {
      for (int k = 0; k < count; k++) on[k] += AT(matrix, i, i)[k] * AT(matrix, i, i)[k];
      for (int j = 0; j < i; j++)
        for (int k = 0; k < count; k++) off[k] += AT(matrix, i, j)[k] * AT(matrix, i, j)[k];
    }
    bool done = true;
    for (int k = 0; k < count; k++) {
      done = done && off[k] <= ROUND_OFF * on[k];
      on[k] *= ROUND_OFF / (n * n);
    }
    if (done) return;
    for (int q = 1; q < n; q++) {
      for (int p = 0; p < q; p++) {
        double* off_diagonal = AT(matrix, q, p);
        bool small = true;
        for (int k = 0; k < count; k++) small = small && off_diagonal[k] * off_diagonal[k] <= on[k];
        if (small) continue;
        angle(count, AT(matrix, p, p), AT(matrix, q, q), off_diagonal, cosine, sine);
        for (int m = 0; m < p; m++) rotate(count, AT(matrix, p, m), AT(matrix, q, m), cosine, sine);
        for (int m = p + 1; m < q; m++) rotate(count, AT(matrix, m, p), AT(matrix, q, m), cosine, sine);
        for (int m = q + 1; m < n; m++) rotate(count, AT(matrix, m, p), AT(matrix, m, q), cosine, sine);
        for (int m = 0; m < n; m++) rotate(count, AT(turn, p, m), AT(turn, q, m), cosine, sine);
      }
    }
  }
#undef AT
}

/* Of a symmetric positive definite matrix, which is lost. */
void heat_inverse(int n, double* matrix, double* inverse) {
  for (int i = 0; i < n * n; i++) inverse[i] = i % (n + 1) == 0;
  for (int c = 0; c < n; c++) {
    double pivot = 1 / matrix[c * n + c];
    for (int k = 0; k < n; k++) {
      matrix[c * n + k] *= pivot;
      inverse[c * n + k] *= pivot;
    }
    for (int r = 0; r < n; r++) {
      double factor = r == c ? 0 : matrix[r * n + c];
      for (int k = 0; k < n; k++) {
        matrix[r * n + k] -= factor * matrix[c * n + k];
        inverse[r * n + k] -= factor * inverse[c * n + k];
      }
    }
  }
}
