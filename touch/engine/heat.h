/* Heat of fingertips and objects inside MuJoCo's step: the numbers that Python hands over, and the parts of a sample.

The laws, their sources and their constants are those of the Python package, which stays the reference: contacts/ and
heat/ of touch, contact/, kernels/ and network/ of thermal. A file here names the one that it follows.

F: fingertips, O: objects, G: geoms of the objects, N = G + F: what a pad may meet, T = O + F: targets of a contact and
fields, M: patterns of a contact, K: rates, P: places of an object. */

#ifndef THERMOGRASP_HEAT_H
#define THERMOGRASP_HEAT_H

#include <mujoco/mujoco.h>
#include <stdbool.h>
#include <stddef.h>

/* columns of a touch: conductance W/K and force N, sums over substeps; place m and normal, of the last one; sums again:
substeps that touched, how many before the last of them had not, in how many pulses, a half for one from the start, area m2 in contact, and it times its length m and shares of it that are at ends */
enum { CONDUCTANCE, FORCE, PLACE, NORMAL = 5, CLOSED = 8, PAUSED, PULSES, AREA, LENGTH, ASIDE, COLUMNS = ASIDE + 4 };
/* a pad: position m, axes, half sides m and its sensor's width m */
enum { AXES = 3, HALF = 12, WIDTH = 14, PAD = 15 };
/* a box: size, extent and centre m, axes row by row; then W/(m K), J/(m3 K), 1/s to the air and across, first state, early
   K s^.5 */
enum { EXTENT = 3, CENTRE = 6, TURN = 9, CONDUCTIVITY = 18, CAPACITY, LOSS, CROSSING, FIRST, EARLY, BOX };
/* a place: face of the box, middle m along its two axes, fingertip; and 1 where the fingertip is or has just left for
   another, whose patterns are all used, 0 where the even one alone is */
enum { FACE, MIDDLE, TIP = 3, PLACED, ALL = PLACED, SLOT };
enum { IDLE = 12 }; /* places that an object remembers besides those in use */
enum { SHAPE_CYLINDER = 1 };
/* an element that is glued on: object, resistance m K/W of a small contact, W/K of the glue */
enum { ON, SMALL, BOND, GLUED };
/* a table of a curved contact: places along two axes, forces, and of each W/K of the contact and of the gas, m2 of their
   patches and m; then shares, and a power of the force */
enum { OF_CONTACT, OF_GAS, PATCH, WIDE_PATCH, PATCH_LENGTH, WIDE_LENGTH, VALUES };
enum { PLACES = 24, FORCES = 14, ENDS = 4, SHARES = 2 * PLACES + VALUES * FORCES * PLACES * PLACES,
       CURVED = SHARES + ENDS * FORCES * PLACES * PLACES + 1 };
/* a round pad: curvatures, stiffness, half sides, half the face's, stiffness beside it and half the whole pad's sides; what
   it meets: curvatures, half lengths, m3/N of its springs and half its sensor's face; how they lie to one another: two axes,
   the rise of a flat face and where the force presses from the other pad's middle */
enum { BEND = 10, CURVES = 7, SIDES = 8 };
#define WIDE 10.0 /* m, half of what no pad reaches the end of */
static const double pi = 3.14159265358979323846;
/* a mesh from one side: three axes, the first inwards, m along the others where it begins, and (2, 2) m by which its radii are more than its
   distance from the middle */
enum { VIEW = 15 };
/* a rod under a pad, 0 of others: rad/N, N/m^2.5 of the silicone and of the skin, m of the gap and radius; half lengths m */
enum { TURN_BY, SOFT, FIRM, APART, RADIUS, HALF_ROD, HALF_PAD, HALF_FACE, TILT };

/* what is behind an element, see engine/backs.py: whether it moves, its controller, what its last change keeps back, W of the room, what it
reads, and a divider's numbers, supply 0 where its sensor sends a drop */
typedef struct {
  double moves, setpoint, proportional, integral, derivative, limit, cut, answering, room, read, supply, ratio, beta, zero;
} Back;
/* what is remembered: V that the sensor sends, K read, now and before, W, whether it is cut, K of the last change; behind
them the chain */
enum { VOLTAGE, READING, PREVIOUS, INTEGRAL, CUT, CHANGE, CHAIN };

typedef struct {
  double area, share, size[2], across[2], ratio, stiffness, half_pad, half_face, pad_length, face_length, narrowing,
      mean_gap, straight, deep, series, sheet, thick, spot_scale, spot_power, spot_most, gas, jump, flatness, roughness, log_hardness, log_elastic_hardness, elastic_share, shape;
} Law;

/* two round surfaces that touch, see thermal/contact/gas_beside.py */
typedef struct {
  double depth, slope, bend, curvature, left, right, lower, upper;
} Wedge;

enum {
  NODES = 13,     /* of the strips of a pattern */
  FUNCTIONS = 7,  /* along an axis of a patch */
  PATTERNS = 13,  /* that are known */
  TIMES = 33,     /* at which a box's kernel is taken */
  MOMENTS = 16,   /* at which networks are fitted */
  POLES = 3,      /* pairs, of a step */
  SERIES = 13,    /* terms of the separation of rough faces */
  WIDTHS = 13,    /* widths in a table of narrow contacts */
  SPREAD = 4 * WIDTHS * WIDTHS, /* and contacts of which it tells */
  SHARED = 4, /* contacts of a face that know of one another */
  FACE_MODES = 7 /* half waves, from none on, along each axis of a face that contacts hear one another by */
};

typedef struct {
  int rates, places, states;     /* K, P, and most states of an object */
  int tips, fingers;             /* fingertips and the elements that are glued on objects behind them; without these */
  int faces;                     /* of a network of either: 2 where elements have one for their object and one for pads */
  int objects, geoms, targets, partners, patterns, tip_states, sample_steps;
  int tables, sides;             /* of curved contacts; axes, radii of an ellipsoid or views of a mesh, of a partner at most */
  int spreads;                   /* tables of narrow contacts */
  int links;                     /* of the longest chain behind an element */
  int named;                     /* geoms in the attribute "geoms"; roles: of each, the fingertip, or F plus its number among G */
  double timestep, dt, least;
  const double *roles, *pads, *pad_kinds, *boxes, *owner, *narrow, *ripples, *spread, *modes, *tip_rates, *tip_ports, *tip_drop, *tip_basis, *tip_weight, *tip_area;
  const double* seebeck;         /* V/K */
  /* narrow: (spreads, SPREAD, K), ripples: K/W m2 of each one's face, and spread: the numbers of each pair, of the pad,
     of its target across each axis, and of that where all of it is pressed from behind; modes: (FACE_MODES, FACE_MODES, K) of
     each sensor */
  const double *glued, *glued_laws, *first; /* GLUED of each element, Law of each pad on it; K above the air at first */
  const double *backs, *back_first, *back_decay, *back_heat; /* Back, CHAIN + links, (links, links) and links each */
  const double *tip_element, *tip_uniform; /* J, and states where all is 1 K warm */
  const double *bends, *curves;  /* of each pad; of each partner by the axis of its frame */
  const double *laws, *curved;   /* Law of each pad on each partner, by the axis of its frame, and its table's number or -1 */
  const double *views, *viewed;  /* VIEW of each partner by its side, and how many: 0 of what is no mesh */
  const double* radii;           /* m of each partner by its side, 0 of what is no ellipsoid */
  const double* tilts;           /* TILT each, alike */
  const double *bent, *grid;     /* CURVED each; logarithms of their first force and of the next one's ratio, least W/K */
  const double *decay, *times, *to_moments, *moments, *nodes, *jumps, *along, *gram, *poles, *weights;
  const double *separation, *separation_range;
  double* all; /* what the others point into */
  size_t length; /* of all */
} Numbers;

/* Complex numbers at all poles at once; behind the poles is one that weighs nothing. */
typedef double Four __attribute__((vector_size(4 * sizeof(double)), aligned(2 * sizeof(double))));
typedef struct {
  Four real, imag;
} Complex;

/* A field: the network of an object's places, or a fingertip's; x' = -rates x + ports q. ports: of each pattern of each
place, `stride` apart. Of a sample's step, fade: what it leaves of the states; where contacts are closed, kept: what the
step's rational function does, and scale: 1 / (pole + dt rates) of each state; gram: how all ports hear one another at each
pole. The numbers of an object's stand behind one another, the ports last. */
typedef struct {
  int count, n, stride;
  double *places, *rates, *fade, *kept, *ports;
  Complex *scale, *gram;
} Network;

/* matrix: room for a step of so many `ports`. */
typedef struct {
  Network* networks; /* of every target, one for the network before a new place, and those that objects have aside */
  int aside, *turn;  /* of each object: how many, and the next one; worlds that share an mjData come in turns */
  double* impedances; /* of each object, as heat_network keeps them */
  size_t ports;
  Complex* matrix;
  double *room, *kept, *grown;   /* of the states of narrow contacts in a sample: what stays, and s, what a flow leaves */
  int *role, *geom, *body;       /* of the model's geoms, as Numbers.roles or -1; of what a pad may meet */
} Work;

/* The state of an instance, numbers in MuJoCo's plugin_state. */
typedef struct {
  double *count, *touches, *places, *used, *current, *narrow, *x, *backs; /* backs: CHAIN + links of each sensor */
} State;

/* As fmin and fmax of numbers, which compilers call; where the first is none the second is taken. */
static inline double lesser(double a, double b) { return a < b ? a : b; }
static inline double greater(double a, double b) { return a > b ? a : b; }
static inline double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
static inline void subtract(const double a[3], const double b[3], double out[3]) {
  for (int k = 0; k < 3; k++) out[k] = a[k] - b[k];
}

const char* heat_parse(Numbers* numbers, const char* text);
size_t heat_states(const Numbers* numbers);
State heat_state(const Numbers* numbers, double* at);
void heat_reset(const Numbers* numbers, double* at);
bool heat_valid(const Numbers* numbers, const State* state);
void heat_redirect(const Numbers* numbers, double* touches);
void heat_settle(const Numbers* numbers, Work* work, State* state);
bool heat_march(const Numbers* numbers, Work* work, State* state);

/* A sample of what is behind element f. drawn: W. force: N. drop: K. at: what it remembers. x: the element's states, which are
then seen from where its back has gone. */
void heat_behind(const Numbers* numbers, int f, double drawn, double force, double drop, double* at, double* x);

void heat_share_faces(const Numbers* numbers, const Work* work, const State* state, int pairs, const int* pair, const double* own,
                      double* roots, double* resistance, double* difference, int* order, int* members, double* lower, double* mutual);

double heat_offset_of(double share, double length, double width);
double heat_conductance(const Law* law, const Numbers* numbers, double pressure);
void heat_contact(const Law* law, double force, const double place[3], double* area, double* share);
double heat_flat_patch(const Law* law, double area, const double place[3], double width, double shares[4]);
double heat_round_contact(const double* bend, const double* curve, const double sides[SIDES], double force, double y, double z,
                          double* area, double* share, double* longer, double* even, Wedge* wedge);
void heat_beside_round(const Law* law, const Wedge* wedge, double* conducts, double* area, double* length);

double heat_tilted(const double* tilt, double first_force, double force, double slope, double middle, double* pressed);
double heat_curved(const double* table, const double grid[3], double force, double aside, double along, double* area,
                   double* length, double shares[4]);

void heat_read(const Numbers* numbers, const Work* work, const mjModel* m, const mjData* d, const State* state);

void heat_pace(const Numbers* numbers, Network* network, bool tip);
void heat_network(const Numbers* numbers, int object, Network* network, double* impedances, double* room);
size_t heat_impedances(const Numbers* numbers);
void heat_copy_network(const Numbers* numbers, const Network* from, Network* to);
size_t heat_network_room(const Numbers* numbers);
int heat_used_ports(const Numbers* numbers, const Network* network, int* ports);
void heat_carry(const Numbers* numbers, const Network* before, const Network* after, double* x, double* room);
int heat_forgotten(const Numbers* numbers, const Network* network, const double* x, const bool* idle, const bool* gone, bool need,
                   double* room);
size_t heat_carry_room(const Numbers* numbers);

void heat_diagonalise(int n, int count, double* matrix, double* turn);
void heat_inverse(int n, double* matrix, double* inverse);

#endif
