/* Small dense matrices, row by row. */

#include <float.h>
#include <math.h>

#include "heat.h"

#define ROUND_OFF 1e-24 /* of squares off the diagonal beside those on it */

/* Turns a symmetric matrix into its eigenvalues on the diagonal by Jacobi's rotations; turn: eigenvectors in columns.
As thermal/numerics/passive_residues.py. */
void heat_diagonalise(int n, double* matrix, double* turn) {
  for (int i = 0; i < n * n; i++) turn[i] = i % (n + 1) == 0;
  for (int sweep = 0; sweep < 30; sweep++) {
    double off = 0, on = 0;
    for (int i = 0; i < n; i++) {
      on += matrix[i * n + i] * matrix[i * n + i];
      for (int j = 0; j < i; j++) off += matrix[i * n + j] * matrix[i * n + j];
    }
    if (!(off > ROUND_OFF * on)) return;
    for (int p = 0; p < n - 1; p++) {
      for (int q = p + 1; q < n; q++) {
        double apart = matrix[p * n + q];
        if (apart == 0) continue;
        double ratio = (matrix[q * n + q] - matrix[p * n + p]) / (2 * apart);
        double tangent = copysign(1 / (fabs(ratio) + sqrt(ratio * ratio + 1)), ratio);
        double cosine = 1 / sqrt(tangent * tangent + 1), sine = tangent * cosine;
        for (int k = 0; k < n; k++) {
          double a = matrix[k * n + p], b = matrix[k * n + q];
          matrix[k * n + p] = cosine * a - sine * b;
          matrix[k * n + q] = sine * a + cosine * b;
        }
        for (int k = 0; k < n; k++) {
          double a = matrix[p * n + k], b = matrix[q * n + k];
          matrix[p * n + k] = cosine * a - sine * b;
          matrix[q * n + k] = sine * a + cosine * b;
        }
        for (int k = 0; k < n; k++) {
          double a = turn[k * n + p], b = turn[k * n + q];
          turn[k * n + p] = cosine * a - sine * b;
          turn[k * n + q] = sine * a + cosine * b;
        }
      }
    }
  }
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
