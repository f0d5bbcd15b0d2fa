/* What is behind an element and does not stay as warm as it is: a thermostat of finite power, or the core of a sensor with
a heater of its own, as a chain of temperatures above the air's; touch/heat/backs.py and engine/backs.py. */

#include <math.h>

#include "heat.h"

static double* record(const Numbers* numbers, const State* state, int f) {
  return state->backs + (size_t)f * (CHAIN + numbers->links);
}

double heat_warm(const Numbers* numbers, const State* state, int f) { return record(numbers, state, f + 1)[-1]; }

bool heat_stays(const Numbers* numbers, int f) {
  return ((const Back*)numbers->backs)[f].supply == 0 && numbers->back_heat[(f + 1) * numbers->links - 1] == 0;
}

double heat_voltage(const Numbers* numbers, const State* state, int f, double drop) {
  const Back* back = (const Back*)numbers->backs + f;
  if (back->supply == 0) return numbers->seebeck[f] * drop;
  return back->supply / (1 + back->ratio * exp(back->beta / (record(numbers, state, f)[READING] + back->zero)));
}

void heat_behind(const Numbers* numbers, const State* state, int f, double drawn, double force, double drop, double* x) {
  const Back* back = (const Back*)numbers->backs + f;
  int links = numbers->links;
  double *at = record(numbers, state, f), *chain = at + CHAIN, before = chain[links - 1], after[links];
  double error = back->setpoint - at[READING], grown = at[INTEGRAL] + back->integral * error;
  double wanted = back->proportional * error + grown - back->derivative * (at[READING] - at[PREVIOUS]);
  double power = lesser(greater(wanted, 0), back->limit);
  if (!((wanted - power) * error > 0)) at[INTEGRAL] = grown;
  at[CUT] = at[CUT] != 0 || force >= back->cut;
  if (at[CUT] != 0) power = 0;
  power += back->room - drawn + back->answering * at[CHANGE];
  mju_mulMatVec(after, numbers->back_decay + (size_t)f * links * links, chain, links, links);
  for (int i = 0; i < links; i++) chain[i] = after[i] + power * numbers->back_heat[f * links + i];
  at[PREVIOUS] = at[READING];
  at[READING] = back->read < 0 ? before - drop : chain[(int)back->read];
  at[CHANGE] = chain[links - 1] - before;
  for (int k = 0; k < numbers->tip_states; k++) x[k] -= at[CHANGE] * numbers->tip_uniform[f * numbers->tip_states + k];
}
