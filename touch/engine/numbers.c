/* The attribute "numbers": float64 in sixteen hexadecimal digits each, in the order of touch/engine/numbers.py. */

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "heat.h"

enum { VERSION = 20, HEADER = 17, MOST_TIPS = 32, MOST_OBJECTS = 64, MOST_GEOMS = 4096, MOST_STATES = 256, MOST_RATES = 32,
       MOST_TABLES = 4096, MOST_VIEWS = 256, MOST_LINKS = 256,
       MOST_SPREADS = (1 + 2 * AXES) * MOST_TIPS * (MOST_OBJECTS + MOST_TIPS) };

static bool decode(const char* text, size_t count, double* out) {
  if (strspn(text, "0123456789abcdef") != 16 * count) return false;
  for (char digits[17] = {0}; count; count--, text += 16, out++) {
    uint64_t bits = strtoull(memcpy(digits, text, 16), NULL, 16);
    memcpy(out, &bits, sizeof bits);
    if (!isfinite(*out)) return false;
  }
  return true;
}

/* Whether all are whole numbers from 0 to the most. */
static bool within(const double* values, size_t count, size_t stride, double most) {
  for (; count; count--, values += stride)
    if (!(*values >= 0 && *values <= most && *values == floor(*values))) return false;
  return true;
}

/* Whether all are -1 or numbers of so many partners. */
static bool numbered(const double* values, size_t count, int partners) {
  for (; count; count--, values++)
    if (*values != -1 && !within(values, 1, 1, partners - 1)) return false;
  return true;
}

/* Fills the numbers, whose `all` is to be freed. Returns what is wrong with the text, or NULL. */
const char* heat_parse(Numbers* n, const char* text) {
  static const double most[HEADER] = {VERSION,    MOST_TIPS, MOST_OBJECTS, MOST_GEOMS, PATTERNS, MOST_RATES,
                                      MOST_STATES, 1e6,      DBL_MAX,      DBL_MAX,    DBL_MAX,  MOST_GEOMS, MOST_TABLES, MOST_VIEWS,
                                      MOST_LINKS,  MOST_TIPS, MOST_SPREADS};
  memset(n, 0, sizeof *n);
  size_t length = text ? strlen(text) : 0;
  double* at = n->all = malloc(length / 2 + sizeof(double));
  if (!at) return "there is no memory";
  if (length % 16 || length < 16 * HEADER || !decode(text, length / 16, at))
    return "the attribute \"numbers\" is broken or missing: write it with thermograsp.touch.install";
  if (at[0] != VERSION) return "the attribute \"numbers\" is of another version: write it with thermograsp.touch.install";
  for (int i = 0; i < HEADER; i++)
    if (!(at[i] >= (i > 7 && i < 11 ? DBL_MIN : 1) && at[i] <= most[i] && (at[i] == floor(at[i]) || (i > 7 && i < 11))))
      return "the attribute \"numbers\" is of another version or broken: write it with thermograsp.touch.install";
  int tips = n->tips = (int)at[1], objects = n->objects = (int)at[2], geoms = n->geoms = (int)at[3];
  int patterns = n->patterns = (int)at[4], states = n->tip_states = (int)at[6], fingers = n->fingers = (int)at[15];
  int elements = tips - fingers, partners = n->partners = fingers + geoms;
  n->rates = (int)at[5];
  n->sample_steps = (int)at[7];
  n->timestep = at[8];
  n->dt = at[9];
  n->least = at[10];
  n->named = (int)at[11];
  n->tables = (int)at[12];
  n->sides = (int)at[13];
  n->links = (int)at[14];
  n->spreads = (int)at[16];
  if (elements < 0) return "the attribute \"numbers\" has more fingertips than sensors";
  n->faces = elements ? 2 : 1;
  n->targets = tips + objects;
  n->places = tips + IDLE;
  n->states = 1 + n->rates * (2 * patterns * tips + IDLE);
  struct {
    const double** part;
    size_t size;
  } parts[] = {
      {&n->roles, n->named},
      {&n->owner, geoms},
      {&n->pads, (size_t)tips * PAD},
      {&n->pad_kinds, tips},
      {&n->boxes, (size_t)objects * BOX},
      {&n->laws, (size_t)fingers * partners * 3 * (sizeof(Law) / sizeof(double))},
      {&n->curved, (size_t)fingers * partners * n->sides},
      {&n->views, (size_t)partners * n->sides * VIEW},
      {&n->viewed, partners},
      {&n->radii, (size_t)partners * n->sides},
      {&n->tilts, (size_t)fingers * partners * 3 * TILT},
      {&n->bent, (size_t)n->tables * CURVED},
      {&n->narrow, (size_t)n->spreads * SPREAD * n->rates},
      {&n->ripples, n->spreads},
      {&n->spread, (size_t)tips * n->targets * (1 + 2 * AXES)},
      {&n->modes, (size_t)tips * FACE_MODES * FACE_MODES * n->rates},
      {&n->bends, (size_t)fingers * BEND},
      {&n->curves, (size_t)partners * 3 * CURVES},
      {&n->glued, (size_t)elements * GLUED},
      {&n->glued_laws, (size_t)fingers * elements * (sizeof(Law) / sizeof(double))},
      {&n->first, tips},
      {&n->seebeck, tips},
      {&n->backs, (size_t)tips * (sizeof(Back) / sizeof(double))},
      {&n->back_first, (size_t)tips * (CHAIN + n->links)},
      {&n->back_decay, (size_t)tips * n->links * n->links},
      {&n->back_heat, (size_t)tips * n->links},
      {&n->tip_area, tips},
      {&n->tip_rates, (size_t)tips * states},
      {&n->tip_ports, (size_t)tips * n->faces * patterns * states},
      {&n->tip_drop, (size_t)tips * states},
      {&n->tip_element, (size_t)tips * states},
      {&n->tip_uniform, (size_t)tips * states},
      {&n->tip_basis, (size_t)tips * PATTERNS * patterns},
      {&n->tip_weight, (size_t)tips * MOMENTS},
      {&n->decay, n->rates},
      {&n->times, TIMES},
      {&n->to_moments, MOMENTS * TIMES},
      {&n->moments, MOMENTS},
      {&n->nodes, NODES},
      {&n->jumps, FUNCTIONS * NODES},
      {&n->along, 2 * PATTERNS},
      {&n->gram, PATTERNS * PATTERNS},
      {&n->poles, 2 * POLES},
      {&n->weights, 2 * POLES},
      {&n->grid, 3},
      {&n->separation, SERIES},
      {&n->separation_range, 4},
  };
  size_t total = HEADER;
  n->length = length / 16;
  for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
    *parts[i].part = n->all + total;
    total += parts[i].size;
    if (total > length / 16) break;
  }
  if (total != length / 16) return "the attribute \"numbers\" has another length than it says itself";
  size_t law = sizeof(Law) / sizeof(double), laws = (size_t)fingers * partners * 3;
  const double *across = n->laws + offsetof(Law, across) / sizeof(double), *glued_across = n->glued_laws + (across - n->laws);
  for (int f = 0; f < tips; f++)
    if (!numbered(&((const Back*)n->backs)[f].read, 1, n->links)) return "the attribute \"numbers\" reads what is not there";
  /* what is used as an index; wrong values elsewhere give wrong temperatures and no more */
  if (!within(n->roles, n->named, 1, partners - 1) || !within(n->owner, geoms, 1, objects - 1) ||
      !within(across, laws, law, 2) || !within(across + 1, laws, law, 2) ||
      !numbered(n->curved, (size_t)fingers * partners * n->sides, n->tables) || n->sides < 3 ||
      !within(n->glued + ON, elements, GLUED, objects - 1) ||
      !within(glued_across, (size_t)fingers * elements, law, 2) || !within(glued_across + 1, (size_t)fingers * elements, law, 2) ||
      !within(n->spread, (size_t)tips * n->targets * (1 + 2 * AXES), 1, n->spreads - 1) || !within(n->viewed, partners, 1, n->sides) || !within(n->along, 2 * PATTERNS, 1, FUNCTIONS - 1))
    return "the attribute \"numbers\" names something that is not there";
  return NULL;
}
