/* thermograsp.heat: a sensor plugin of MuJoCo. Its data are the voltages of a model's fingertips and glued elements, V before low-pass, noise
and converter; its state holds the fields and the places of all fingertips and objects.

Attributes: "geoms", names with commas between, and "numbers", see numbers.c; thermograsp.touch.install writes both. What
is kept beside the state follows from the state alone: the networks of the places that objects have now. */

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "heat.h"

#define ASIDE 4000000 /* numbers of the networks that objects have aside; the system gives memory only for those in use */
enum { MOST_ASIDE = 1024 };

typedef struct {
  Numbers numbers;
  Work work;
  void* block;
} Heat;

static Heat* heat_of(const mjData* d, int instance) { return (Heat*)d->plugin_data[instance]; }

static int failed(const char* what) {
  mju_warning("thermograsp.heat: %s", what);
  return -1;
}

/* Says where the parts of the work stand in the block, and returns its size in doubles; each part begins on a line of the
processor's cache. */
static size_t lay_out(const Numbers* n, Work* work, const mjModel* m, double* block) {
  size_t used = 0, wide = (size_t)n->places * n->patterns, faced = (size_t)n->faces * n->patterns;
  size_t size = n->places * SLOT + n->states * (3 + wide) + (n->states + wide * wide) * (sizeof(Complex) / sizeof(double));
  size_t aside = ASIDE / (size * n->objects);
  work->aside = aside < 1 ? 1 : aside > MOST_ASIDE ? MOST_ASIDE : (int)aside;
  int networks = n->targets + 1 + n->objects * work->aside;
#define PART(name, count, type)                                       \
  do {                                                                \
    if (block) (name) = (type*)(block + used);                        \
    used += ((count) * sizeof(type) + 63) / 64 * (64 / sizeof(double)); \
  } while (0)
  PART(work->networks, networks, Network);
  for (int t = 0; t < networks; t++) {
    bool tip = t >= n->objects && t < n->targets;
    Network none, *network = block ? &work->networks[t] : &none;
    size_t states = network->stride = tip ? n->tip_states : n->states;
    PART(network->places, tip ? 0 : (size_t)n->places * SLOT, double);
    PART(network->rates, states, double);
    PART(network->fade, states, double);
    PART(network->kept, states, double);
    PART(network->scale, states, Complex);
    PART(network->gram, tip ? faced * faced : wide * wide, Complex);
    PART(network->ports, (tip ? n->faces : n->places) * n->patterns * states, double);
  }
  PART(work->turn, n->objects, int);
  PART(work->impedances, n->objects * heat_impedances(n), double);
  PART(work->kept, n->rates, double);
  PART(work->grown, n->rates, double);
  PART(work->role, m->ngeom, int);
  PART(work->geom, n->partners, int);
  PART(work->body, n->partners, int);
  size_t room = heat_network_room(n), other = heat_carry_room(n), forces = (size_t)n->fingers * n->partners * 3;
  room = room > other ? room : other;
  PART(work->room, room > forces ? room : forces, double);
#undef PART
  return used;
}

/* Whether the model's steps are as long as those that the numbers are made for. */
static bool on_time(const Numbers* n, const mjModel* m) { return fabs(m->opt.timestep - n->timestep) <= 1e-9 * n->timestep; }

/* Finds the geoms by their names. */
static const char* find(const Numbers* n, Work* work, const mjModel* m, const char* names) {
  if (!names) return "the attribute \"geoms\" is missing: write it with thermograsp.touch.install";
  for (int g = 0; g < m->ngeom; g++) work->role[g] = -1;
  for (int g = 0; g < n->partners; g++) work->geom[g] = work->body[g] = -1;
  for (int i = 0; i < n->named; i++) {
    char name[512];
    size_t length = strcspn(names, ",");
    if (length >= sizeof name) return "a name in the attribute \"geoms\" is too long";
    memcpy(name, names, length);
    name[length] = 0;
    names += length + (names[length] == ',');
    int geom = mj_name2id(m, mjOBJ_GEOM, name), role = (int)n->roles[i];
    if (geom < 0) return "the attribute \"geoms\" names a geom that the model does not have: install after all other changes";
    if (work->role[geom] >= 0) return "the attribute \"geoms\" names a geom twice";
    int partner = role < n->fingers ? n->geoms + role : role - n->fingers;
    work->role[geom] = role;
    work->body[partner] = m->geom_bodyid[geom];
    if (role >= n->fingers) work->geom[partner] = geom;
  }
  if (*names) return "the attribute \"geoms\" has more names than there are numbers for";
  for (int g = 0; g < n->partners; g++)
    if (work->body[g] < 0) return "the attribute \"geoms\" lacks a name";
  if (!on_time(n, m))
    return "the model's timestep has changed since thermograsp.touch.install: install again";
  return NULL;
}

static int nstate(const mjModel* m, int instance) {
  Numbers numbers;
  const char* wrong = heat_parse(&numbers, mj_getPluginConfig(m, instance, "numbers"));
  int count = wrong ? failed(wrong) : (int)heat_states(&numbers);
  free(numbers.all);
  return count;
}

static int nsensordata(const mjModel* m, int instance, int sensor) {
  (void)sensor;
  Numbers numbers;
  int count = heat_parse(&numbers, mj_getPluginConfig(m, instance, "numbers")) ? 0 : numbers.tips; /* nstate tells */
  free(numbers.all);
  return count;
}

static void destroy(mjData* d, int instance) {
  Heat* heat = heat_of(d, instance);
  if (!heat) return;
  free(heat->work.matrix);
  free(heat->numbers.all);
  free(heat->block);
  free(heat);
  d->plugin_data[instance] = 0;
}

static int init(const mjModel* m, mjData* d, int instance) {
  Heat* heat = calloc(1, sizeof *heat);
  d->plugin_data[instance] = (uintptr_t)heat;
  if (!heat) return failed("there is no memory");
  Numbers* n = &heat->numbers;
  const char* wrong = heat_parse(n, mj_getPluginConfig(m, instance, "numbers"));
  if (!wrong) {
    size_t size = 64 + lay_out(n, &heat->work, m, NULL) * sizeof(double);
    heat->block = calloc(1, size);
    if (!heat->block) wrong = "there is no memory";
  }
  if (!wrong) {
    lay_out(n, &heat->work, m, (double*)(((uintptr_t)heat->block + 63) / 64 * 64));
    wrong = find(n, &heat->work, m, mj_getPluginConfig(m, instance, "geoms"));
  }
  if (wrong) {
    destroy(d, instance);
    return failed(wrong);
  }
  for (int t = 0; t < n->targets + 1 + n->objects * heat->work.aside; t++) heat->work.networks[t].count = -1;
  for (int f = 0; f < n->tips; f++) {
    Network* network = &heat->work.networks[n->objects + f];
    network->count = n->faces;
    int states = network->n = n->tip_states, ports = n->faces * n->patterns * states;
    memcpy(network->rates, n->tip_rates + f * states, sizeof(double) * states);
    memcpy(network->ports, n->tip_ports + f * ports, sizeof(double) * ports);
    heat_pace(n, network, true);
  }
  for (int k = 0; k < n->rates; k++) {
    heat->work.kept[k] = exp(-n->dt * n->decay[k]);
    heat->work.grown[k] = (1 - heat->work.kept[k]) / n->decay[k];
  }
  heat_reset(n, d->plugin_state + m->plugin_stateadr[instance]);
  return 0;
}

static void reset(const mjModel* m, mjtNum* plugin_state, void* plugin_data, int instance) {
  (void)m, (void)instance;
  Heat* heat = plugin_data;
  if (heat) heat_reset(&heat->numbers, plugin_state);
}

/* The networks go with a copy, as making them again would take milliseconds, but not to a model of other numbers. */
static void copy(mjData* dest, const mjModel* m, const mjData* src, int instance) {
  (void)m;
  const Heat* from = heat_of(src, instance);
  Heat* to = heat_of(dest, instance);
  if (!from || !to) return;
  const Numbers *n = &from->numbers, *other = &to->numbers;
  if (n->length != other->length || memcmp(n->all, other->all, n->length * sizeof(double))) return;
  for (int o = 0; o < n->objects; o++) heat_copy_network(n, &from->work.networks[o], &to->work.networks[o]);
}

static void compute(const mjModel* m, mjData* d, int instance, int capability) {
  (void)capability;
  const Heat* heat = heat_of(d, instance);
  const Numbers* n = &heat->numbers;
  State state = heat_state(n, d->plugin_state + m->plugin_stateadr[instance]);
  bool known = on_time(n, m);
  for (int s = 0; s < m->nsensor; s++) {
    if (m->sensor_type[s] != mjSENS_PLUGIN || m->sensor_plugin[s] != instance) continue;
    for (int f = 0; f < n->tips; f++)
      d->sensordata[m->sensor_adr[s] + f] = known ? state.backs[f * (CHAIN + n->links) + VOLTAGE] : NAN;
  }
}

static void advance(const mjModel* m, mjData* d, int instance) {
  Heat* heat = heat_of(d, instance);
  const Numbers* n = &heat->numbers;
  double* at = d->plugin_state + m->plugin_stateadr[instance];
  State state = heat_state(n, at);
  if (!(*state.count >= 0 && *state.count < n->sample_steps)) heat_reset(n, at);
  heat_read(n, &heat->work, m, d, &state);
  if (++*state.count < n->sample_steps) return;
  *state.count = 0;
  if (heat_valid(n, &state)) {
    heat_redirect(n, state.touches);
    heat_settle(n, &heat->work, &state);
    if (!heat_march(n, &heat->work, &state)) failed("there is no memory: a sample of heat is left out");
    memset(state.touches, 0, sizeof(double) * n->tips * n->targets * COLUMNS);
  } else {
    heat_reset(n, at);
  }
}

__attribute__((constructor)) static void enter(void) {
  static const char* attributes[] = {"geoms", "numbers"};
  mjpPlugin plugin;
  mjp_defaultPlugin(&plugin);
  plugin.name = "thermograsp.heat";
  plugin.nattribute = 2;
  plugin.attributes = attributes;
  plugin.capabilityflags = mjPLUGIN_SENSOR;
  plugin.needstage = mjSTAGE_POS;
  plugin.nstate = nstate;
  plugin.nsensordata = nsensordata;
  plugin.init = init;
  plugin.destroy = destroy;
  plugin.copy = copy;
  plugin.reset = reset;
  plugin.compute = compute;
  plugin.advance = advance;
  mjp_registerPlugin(&plugin);
}
