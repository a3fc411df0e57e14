/* The rigid five-bar under path following on a closed curve, written by hand.
 *
 * An independent derivation of what models/closed_loop/kernel.py assembles from symbols, and the
 * yardstick for its speed. LANES robots advance together, one in each lane of a SIMD register; with
 * LANES = 1 this is ordinary C. Vectors are laid out as the kernel says; the curve's table is 25
 * columns of 8.
 */
#include <math.h>
#include <string.h>

#if LANES == 1
typedef double Real;
typedef int Mask;
static Real all(double value) { return value; }
static Real choose(Mask mask, Real yes, Real no) { return mask ? yes : no; }
static Mask not(Mask mask) { return !mask; }
static Real sine(Real x) { return sin(x); }
static Real cosine(Real x) { return cos(x); }
#else
typedef double Real __attribute__((vector_size(8 * LANES)));
typedef long long Mask __attribute__((vector_size(8 * LANES)));
static Real all(double value) { return (Real){0} + value; }
static Real choose(Mask mask, Real yes, Real no) {
  return (Real)((mask & (Mask)yes) | (~mask & (Mask)no));
}
static Mask not(Mask mask) { return ~mask; }
#if LANES == 8 && defined(__AVX512F__)
extern Real _ZGVeN8v_sin(Real), _ZGVeN8v_cos(Real); /* of glibc's libmvec */
static Real sine(Real x) { return _ZGVeN8v_sin(x); }
static Real cosine(Real x) { return _ZGVeN8v_cos(x); }
#elif LANES == 4 && defined(__AVX2__)
extern Real _ZGVdN4v_sin(Real), _ZGVdN4v_cos(Real);
static Real sine(Real x) { return _ZGVdN4v_sin(x); }
static Real cosine(Real x) { return _ZGVdN4v_cos(x); }
#endif
#endif

/* A function of one number, for every lane; the compiler makes it one instruction. */
#define FOR_EACH_LANE(name, function)                       \
  static Real name(Real x) {                                \
    double lanes[LANES];                                    \
    memcpy(lanes, &x, sizeof x);                            \
    for (int i = 0; i < LANES; ++i) lanes[i] = function(lanes[i]); \
    memcpy(&x, lanes, sizeof x);                            \
    return x;                                               \
  }
FOR_EACH_LANE(root, sqrt)
FOR_EACH_LANE(magnitude, fabs)
FOR_EACH_LANE(whole, floor)

enum { HARMONICS = 12, COLUMNS = 2 * HARMONICS + 1, ROWS = 8, NEWTON_STEPS = 2 };

typedef struct { Real x, y; } Vec;
typedef struct {
  Vec q, v;
  Real theta, theta_rate, theta_ref, speed_ref;
  Vec integral, encoder, encoder_rate, estimate, estimate_rate, u;
  Real phase, ticks;
  Vec queue[8];
} State;
typedef struct { Real M11, M22, M12, G1, G2, b1, b2, l1, l4; } Plant;
typedef struct {
  Real K1, K2, K3, K4, K5, position, target, speed, ramp, speed_limit, tracker_integral;
  Real plane[3]; /* of paths in space */
  Vec level_centre;
  Real level_weights[3];
  Real level_constant;
  Real plan[40]; /* of other laws */
  Real torque_limit, coulomb, encoder_step, encoder_filter, hold_ticks, dt;
  Real observer_time, stiction, torque_step, look_ahead, delay_ticks, sensor_noise, seed;
  Real hand_active;
  Vec hand_target;
  Real hold_active;
  Vec hold_anchor, hold_tangent, hold_normal;
  Real wall_active;
  Vec wall_place, wall_normal;
  Plant plant, model;
} Settings;
typedef struct {
  Vec q, v, y;
  Real theta, theta_rate, speed, theta_ref, speed_ref, xi, xi_rate;
  Vec u, force;
  Real far, integral_used;
} Row;
typedef struct { Vec sigma, first, second, third; } Local;
typedef struct { Real c1, s1, c2, s2; } Angles;

static Vec add(Vec a, Vec b) { return (Vec){a.x + b.x, a.y + b.y}; }
static Vec sub(Vec a, Vec b) { return (Vec){a.x - b.x, a.y - b.y}; }
static Vec scaled(Real k, Vec a) { return (Vec){k * a.x, k * a.y}; }
static Vec along(Vec a, Real k, Vec b) { return (Vec){a.x + k * b.x, a.y + k * b.y}; }
static Real dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y; }
static Real larger(Real a, Real b) { return choose(a > b, a, b); }
static Real clamp(Real x, Real low, Real high) {
  return choose(x < low, low, choose(x > high, high, x));
}
static Real risen(Real x) {
  x = clamp(x, all(0), all(1));
  return x * x * (3 - 2 * x);
}
static Real wrap(Real a) { return a - 2 * M_PI * whole(a / (2 * M_PI) + 0.5); }
static Angles angles(Vec q) {
  return (Angles){cosine(q.x), sine(q.x), cosine(q.y), sine(q.y)};
}

static Vec tip(const Plant *p, Angles a) {
  return (Vec){p->l1 * a.c1 - p->l4 * a.c2 - p->l4, p->l1 * a.s1 - p->l4 * a.s2 - p->l1};
}
static Vec tip_rate(const Plant *p, Angles a, Vec v) {
  return (Vec){-p->l1 * a.s1 * v.x + p->l4 * a.s2 * v.y, p->l1 * a.c1 * v.x - p->l4 * a.c2 * v.y};
}

/* The curve and three derivatives at theta. */
static Local curve_at(const Real *restrict table, Real theta) {
  Real c = cosine(theta), s = sine(theta), basis[COLUMNS], sum[ROWS];
  basis[0] = all(1);
  Real ck = c, sk = s;
  for (int k = 1; k <= HARMONICS; ++k) {
    basis[k] = ck;
    basis[HARMONICS + k] = sk;
    Real turned = c * ck - s * sk;
    sk = s * ck + c * sk;
    ck = turned;
  }
  for (int i = 0; i < ROWS; ++i) sum[i] = table[i];
  for (int k = 1; k < COLUMNS; ++k)
    for (int i = 0; i < ROWS; ++i) sum[i] += table[ROWS * k + i] * basis[k];
  return (Local){{sum[0], sum[1]}, {sum[2], sum[3]}, {sum[4], sum[5]}, {sum[6], sum[7]}};
}

/* The closest point to z by Newton on the curve's cubic polynomial; moves theta there. */
static Local project(Local at, Vec z, Real *theta) {
  for (int i = 0; i < NEWTON_STEPS; ++i) {
    Vec gap = sub(at.sigma, z);
    Real square = dot(at.first, at.first);
    Real slope = larger(square + dot(gap, at.second), 0.05 * square);
    Real h = -clamp(dot(gap, at.first) / slope, all(-0.5), all(0.5));
    *theta += h;
    at.sigma = along(at.sigma, h, along(at.first, h / 2, along(at.second, h / 3, at.third)));
    at.first = along(at.first, h, along(at.second, h / 2, at.third));
    at.second = along(at.second, h, at.third);
  }
  return at;
}

/* v' = M^-1 (tau - c). */
static Vec acceleration(const Plant *p, Vec q, Vec v, Vec tau) {
  Angles a = angles(q);
  Real m12 = p->M12 * (a.c1 * a.c2 + a.s1 * a.s2), n12 = p->M12 * (a.s2 * a.c1 - a.c2 * a.s1);
  Real f1 = tau.x - p->G1 * a.c1 - p->b1 * v.x + n12 * v.y * v.y;
  Real f2 = tau.y - p->G2 * a.c2 - p->b2 * v.y - n12 * v.x * v.x;
  Real inverse = 1 / (p->M11 * p->M22 - m12 * m12);
  return (Vec){inverse * (p->M22 * f1 - m12 * f2), inverse * (p->M11 * f2 - m12 * f1)};
}

/* Torques that give the end-point the acceleration a_y, if the model is right. */
static Vec torques(const Plant *p, Angles a, Vec v, Vec a_y) {
  Real l1 = p->l1, l4 = p->l4, v1v1 = v.x * v.x, v2v2 = v.y * v.y;
  Vec b = {a_y.x + l1 * a.c1 * v1v1 - l4 * a.c2 * v2v2,
           a_y.y + l1 * a.s1 * v1v1 - l4 * a.s2 * v2v2};
  Real sin12 = a.s1 * a.c2 - a.c1 * a.s2, cos12 = a.c1 * a.c2 + a.s1 * a.s2;
  Real w1 = -(a.c2 * b.x + a.s2 * b.y) / (l1 * sin12);
  Real w2 = -(a.c1 * b.x + a.s1 * b.y) / (l4 * sin12);
  Real m12 = p->M12 * cos12, n12 = -p->M12 * sin12;
  return (Vec){p->M11 * w1 + m12 * w2 + p->G1 * a.c1 + p->b1 * v.x - n12 * v2v2,
               m12 * w1 + p->M22 * w2 + p->G2 * a.c2 + p->b2 * v.y + n12 * v1v1};
}

static Real brake(const Settings *s, Vec y, Vec y_rate, Vec direction) {
  Real pressed = 2000 * dot(direction, sub(y, s->hold_anchor)) + 40 * dot(direction, y_rate);
  return -s->hold_active * clamp(pressed, all(-30), all(30));
}

static Vec pushes(const Settings *s, Vec y, Vec y_rate) {
  Vec hand = along(scaled(all(300), sub(s->hand_target, y)), all(-10), y_rate);
  Real size = root(dot(hand, hand) + 1e-12);
  Real depth = dot(s->wall_normal, sub(s->wall_place, y));
  Real pressed = 2000 * depth - 40 * dot(s->wall_normal, y_rate);
  Real solid = s->wall_active * choose(depth > 0, clamp(pressed, all(0), all(30)), all(0));
  hand = scaled(s->hand_active * choose(size > 15, 15 / size, all(1)), hand);
  Vec held = along(scaled(brake(s, y, y_rate, s->hold_tangent), s->hold_tangent),
                   brake(s, y, y_rate, s->hold_normal), s->hold_normal);
  return along(add(hand, held), solid, s->wall_normal);
}

static void integrate(const Plant *p, Vec *q, Vec *v, Vec tau, Real h) {
  Vec a1 = acceleration(p, *q, *v, tau);
  Vec v2 = along(*v, h / 2, a1), a2 = acceleration(p, along(*q, h / 2, *v), v2, tau);
  Vec v3 = along(*v, h / 2, a2), a3 = acceleration(p, along(*q, h / 2, v2), v3, tau);
  Vec v4 = along(*v, h, a3), a4 = acceleration(p, along(*q, h, v3), v4, tau);
  *q = along(*q, h / 6, add(add(*v, v4), scaled(all(2), add(v2, v3))));
  *v = along(*v, h / 6, add(add(a1, a4), scaled(all(2), add(a2, a3))));
}

/* The speed reference at the beginning of a tick, and its rate. */
static Real speed_ref(const Settings *s, const State *x) {
  return choose(s->ramp > 0, x->speed_ref, s->speed);
}
static Real speed_ref_rate(const Settings *s, const State *x) {
  return clamp((s->speed - x->speed_ref) / s->dt, -s->ramp, s->ramp);
}

/* Coordinates of z and their rates along and across the path, whose closest point is known. */
typedef struct {
  Vec T, N;
  Real length, curvature, bent, theta_rate, lambda, lambda_rate;
} Place;

static Place place(Local at, Vec z, Vec z_rate) {
  Place p;
  p.length = root(dot(at.first, at.first));
  p.T = scaled(1 / p.length, at.first), p.N = (Vec){-p.T.y, p.T.x};
  p.lambda = dot(p.N, sub(z, at.sigma)), p.lambda_rate = dot(p.N, z_rate);
  p.curvature = dot(p.N, at.second) / (p.length * p.length);
  p.bent = 1 - p.lambda * p.curvature;
  p.theta_rate = dot(p.T, z_rate) / (p.length * p.bent);
  return p;
}

/* The share of the return from far away in the command. */
static Real far_from_path(const Settings *s, Place p, Real theta, Real speed) {
  Real left = magnitude(wrap(theta - s->target));
  Real wanted = choose(s->position != 0, root(s->K4) * left, magnitude(speed));
  Real turn = (magnitude(p.theta_rate) - wanted) * s->dt * s->hold_ticks;
  return larger(risen((0.5 - larger(p.bent, all(0.05))) / 0.3), risen((turn - 0.15) / 0.15));
}

/* Commanded y'' in the frame of the closest point: z = sigma + lambda N, differentiated twice. */
static Vec command(const Settings *s, const State *x, Local at, Place p, Real theta, Real ahead) {
  Real g = p.length * p.bent, turn = p.curvature * p.length * p.theta_rate;
  Real stretch = dot(p.T, at.second), per_square = 1 / (p.length * p.length);
  Real curving = dot(p.N, at.third) * per_square - 3 * p.curvature * stretch / p.length;
  Real g_rate = p.theta_rate * (stretch * p.bent - p.length * p.lambda * curving)
                - p.length * p.lambda_rate * p.curvature;
  Real across = -s->K1 * p.lambda - s->K2 * p.lambda_rate - s->K3 * x->integral.x;
  Real to_target = -s->K4 * wrap(theta - s->target) - s->K5 * p.theta_rate;
  Real speed_rate = speed_ref_rate(s, x), speed = speed_ref(s, x) + ahead * speed_rate;
  Real onward = choose(s->position != 0, to_target, speed_rate + s->K5 * (speed - p.theta_rate));
  Vec tangential = scaled(g * onward + g_rate * p.theta_rate - p.lambda_rate * turn, p.T);
  return along(tangential, across + g * p.theta_rate * turn, p.N);
}

static void tick(const Settings *s, const Real *table, State *x, Row *row) {
  Real ahead = s->look_ahead;
  Vec gain = scaled(ahead, acceleration(&s->model, x->q, x->v, x->u));
  Vec q = along(x->q, ahead, along(x->v, all(0.5), gain)), v = add(x->v, gain);
  Angles a = angles(q);
  Vec z = tip(&s->model, a);
  Real theta = x->theta + s->dt * x->theta_rate, theta_now = theta;
  Local predicted = curve_at(table, theta), at = project(predicted, z, &theta);
  Place there = place(at, z, tip_rate(&s->model, a, v));
  Vec near = command(s, x, at, there, theta, ahead), z_rate = tip_rate(&s->model, a, v);
  Vec home = along(scaled(-s->K1, sub(z, at.sigma)), -s->K2, z_rate);
  Real far = far_from_path(s, there, theta, speed_ref(s, x) + ahead * speed_ref_rate(s, x));
  Vec wanted = torques(&s->model, a, v, along(scaled(1 - far, near), far, home));

  a = angles(x->q), z = tip(&s->model, a);
  at = project(predicted, z, &theta_now);
  Place now = place(at, z, tip_rate(&s->model, a, x->v));

  Real limit = s->torque_limit;
  Mask acts = x->phase < 0.5;
  Mask saturated = larger(magnitude(wanted.x), magnitude(wanted.y)) > limit;
  Vec u = {choose(acts, clamp(wanted.x, -limit, limit), x->u.x),
           choose(acts, clamp(wanted.y, -limit, limit), x->u.y)};

  Vec y = tip(&s->plant, a), force = pushes(s, y, tip_rate(&s->plant, a, x->v));
  Vec tau = {s->plant.l1 * (a.c1 * force.y - a.s1 * force.x)
                 + u.x - s->coulomb * x->v.x / root(x->v.x * x->v.x + 0.0025),
             s->plant.l4 * (a.s2 * force.x - a.c2 * force.y)
                 + u.y - s->coulomb * x->v.y / root(x->v.y * x->v.y + 0.0025)};
  row->q = x->q, row->v = x->v, row->y = y, row->theta_ref = x->theta_ref;
  row->speed_ref = speed_ref(s, x);
  row->u = u, row->force = force, row->far = far;

  Real used = s->K3 * root(dot(x->integral, x->integral)) / (s->K1 * 0.01);
  row->integral_used = choose(used < 1, used, all(1));

  integrate(&s->plant, &x->q, &x->v, tau, s->dt);
  Mask integrates = acts & not(saturated);
  Real more = choose(integrates, s->dt * s->hold_ticks * there.lambda, all(0));
  x->integral.x = choose(s->K3 == 0, all(0), x->integral.x + more);
  x->integral.y = choose(s->K3 == 0, all(0), x->integral.y);
  Real most = s->K1 * 0.01, size = s->K3 * root(dot(x->integral, x->integral));
  x->integral = scaled(choose(size > most, most / size, all(1)), x->integral);
  Real speed_rate = speed_ref_rate(s, x), speed = speed_ref(s, x) + s->dt / 2 * speed_rate;
  x->speed_ref = speed_ref(s, x) + s->dt * speed_rate;
  Real top = magnitude(speed), gap = wrap(s->target - x->theta_ref) / s->dt;
  x->theta_ref += s->dt * choose(s->position != 0, clamp(gap, -top, top), speed);
  x->theta = theta, x->theta_rate = there.theta_rate;
  row->theta = theta_now, row->theta_rate = now.theta_rate;
  row->speed = now.theta_rate * now.length;
  row->xi = now.lambda, row->xi_rate = now.lambda_rate;
  x->encoder = row->q, x->encoder_rate = row->v, x->u = u;
  x->estimate = x->q, x->estimate_rate = x->v;
  x->phase = choose(x->phase + 1 < s->hold_ticks - 0.5, x->phase + 1, all(0));
}

/* Vectors of LANES robots, one after the other, to and from one vector of lanes. */
static void load(Real *to, const double *from, int size) {
  for (int j = 0; j < size; ++j)
    for (int lane = 0; lane < LANES; ++lane) ((double *)(to + j))[lane] = from[lane * size + j];
}
static void store(double *to, long long stride, const Real *from, int size) {
  for (int lane = 0; lane < LANES; ++lane)
    for (int j = 0; j < size; ++j) to[lane * stride + j] = ((const double *)(from + j))[lane];
}

#define SIZE(type) ((int)(sizeof(type) / sizeof(Real)))

/* The number of robots must be a multiple of LANES. */
void onpath_run(const double *settings, const double *tables, double *states, double *logs,
                long long ticks, long long robots) {
  for (long long i = 0; i < robots; i += LANES) {
    Settings s;
    State x;
    Real table[ROWS * COLUMNS];
    load((Real *)&s, settings + i * SIZE(Settings), SIZE(Settings));
    load((Real *)&x, states + i * SIZE(State), SIZE(State));
    load(table, tables + i * SIZE(table), SIZE(table));
    for (long long k = 0; k < ticks; ++k) {
      Row row;
      tick(&s, table, &x, &row);
      store(logs + (ticks * i + k) * SIZE(Row), ticks * SIZE(Row), (Real *)&row, SIZE(Row));
    }
    store(states + i * SIZE(State), SIZE(State), (Real *)&x, SIZE(State));
  }
}
