/* What is behind an element and does not stay as warm as it is: a thermostat of finite power, or the core of a sensor with
a heater of its own, as a chain of temperatures above the air's; touch/heat/backs.py and engine/backs.py. */

#include <math.h>

#include "heat.h"

void heat_behind(const Numbers* numbers, int f, double drawn, double force, double drop, double* at, double* x) {
  const Back* back = (const Back*)numbers->backs + f;
  int links = numbers->links;
  double *chain = at + CHAIN, before = chain[links - 1], after[links];
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
  if (back->supply > 0) at[VOLTAGE] = back->supply / (1 + back->ratio * exp(back->beta / (at[READING] + back->zero)));
}
