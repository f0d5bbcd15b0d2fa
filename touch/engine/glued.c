/* Elements that are glued on objects, as touch/contacts/glued.py. */

#include <math.h>

#include "heat.h"

#define FACING 0.6 /* least cosine between the way that a pad looks and the way into the object */

/* Whether a pad that touches the object is on element e; place: where from its middle, along its axes. */
static bool meets(const Numbers* numbers, const double* touch, int e, const Law* law, double place[3]) {
  const double* pad = numbers->pads + (numbers->fingers + e) * PAD;
  double away[3], half = law->half_pad + pad[WIDTH] / 2;
  subtract(touch + PLACE, pad, away);
  for (int a = 0; a < 3; a++) place[a] = dot(pad + AXES + 3 * a, away);
  return touch[FORCE] > 0 && dot(touch + NORMAL, pad + AXES) >= FACING && fabs(place[1]) < half && fabs(place[2]) < half;
}

/* Where an element lies, a pad touches the element and not its object; every element is on its object. */
void heat_redirect(const Numbers* numbers, double* touches) {
  static const double sides[SIDES] = {1, 0, 0, 1};
  int fingers = numbers->fingers, elements = numbers->tips - fingers, targets = numbers->targets;
  for (int e = 0; e < elements; e++) {
    const double *glued = numbers->glued + e * GLUED, *pad = numbers->pads + (fingers + e) * PAD;
    int on = (int)glued[ON];
    double *bond = touches + ((fingers + e) * targets + on) * COLUMNS, width = pad[WIDTH];
    bond[CONDUCTANCE] = numbers->sample_steps * glued[BOND];
    mju_copy3(bond + PLACE, pad);
    mju_copy3(bond + NORMAL, pad + AXES);
    for (int f = 0; f < fingers; f++) {
      double *touch = touches + (f * targets + on) * COLUMNS, place[3], other[3], area, share, longer, even;
      const Law* laws = (const Law*)numbers->glued_laws + f * elements;
      if (!meets(numbers, touch, e, laws + e, place)) continue;
      int meeting = 0;
      for (int i = 0; i < elements; i++)
        meeting += numbers->glued[i * GLUED + ON] == on && meets(numbers, touch, i, laws + i, other);
      const double *bend = numbers->bends + f * BEND, curve[CURVES] = {0, 0, width / 2, width / 2, 0, WIDE, WIDE};
      double pressed = touch[FORCE] / numbers->sample_steps / meeting;
      Wedge beside;
      if (bend[0] + bend[1] > 0) heat_round_contact(bend, curve, sides, pressed, 0, 0, &area, &share, &longer, &even, &beside);
      else heat_contact(laws + e, pressed, place, &area, &share);
      /* the element stands out: a pad that reaches it at all is on it, and not on the object beside it */
      touch[CONDUCTANCE] = 0;
      if (!(area > 0 && share > 0)) continue;
      double resists = 1 / (heat_conductance(laws + e, numbers, share / area) * area);
      resists += glued[SMALL] * (1 / lesser(sqrt(area), width) - 1 / width);
      touches[(f * targets + numbers->objects + fingers + e) * COLUMNS + CONDUCTANCE] = numbers->sample_steps / resists;
    }
  }
}
