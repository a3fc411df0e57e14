/* The rigid five-bar under path following on a closed curve, written by hand.
 *
 * An independent derivation of what models/kernel.py assembles from symbols, and the yardstick for
 * its speed. Vectors are laid out as the kernel says; the curve's table is 25 columns of 8.
 */
#include <math.h>

enum { HARMONICS = 12, COLUMNS = 2 * HARMONICS + 1, ROWS = 8, NEWTON_STEPS = 2 };

typedef struct { double x, y; } Vec;
typedef struct {
  Vec q, v;
  double theta, theta_rate, theta_ref;
  Vec integral, encoder, encoder_rate, u;
  double phase;
} State;
typedef struct { double M11, M22, M12, G1, G2, b1, b2, l1, l4; } Plant;
typedef struct {
  double K1, K2, K3, K4, K5, position, target, speed;
  Vec level_centre, level_weights;
  double level_constant;
  double torque_limit, coulomb, encoder_step, encoder_filter, hold_ticks, dt;
  double hand_active;
  Vec hand_target;
  double hold_active;
  Vec hold_anchor, hold_tangent;
  Plant plant, model;
} Settings;
typedef struct {
  Vec q, v, y;
  double theta, theta_rate, speed, theta_ref, xi, xi_rate;
  Vec u, force;
} Row;
typedef struct { Vec sigma, first, second, third; } Local;
typedef struct { double c1, s1, c2, s2; } Angles;

static Vec add(Vec a, Vec b) { return (Vec){a.x + b.x, a.y + b.y}; }
static Vec sub(Vec a, Vec b) { return (Vec){a.x - b.x, a.y - b.y}; }
static Vec scaled(double k, Vec a) { return (Vec){k * a.x, k * a.y}; }
static Vec along(Vec a, double k, Vec b) { return (Vec){a.x + k * b.x, a.y + k * b.y}; }
static double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y; }
static double clamp(double x, double low, double high) {
  return x < low ? low : x > high ? high : x;
}
static double wrap(double a) { return a - 2 * M_PI * floor(a / (2 * M_PI) + 0.5); }
static Angles angles(Vec q) { return (Angles){cos(q.x), sin(q.x), cos(q.y), sin(q.y)}; }

static Vec tip(const Plant *p, Angles a) {
  return (Vec){p->l1 * a.c1 - p->l4 * a.c2 - p->l4, p->l1 * a.s1 - p->l4 * a.s2 - p->l1};
}
static Vec tip_rate(const Plant *p, Angles a, Vec v) {
  return (Vec){-p->l1 * a.s1 * v.x + p->l4 * a.s2 * v.y, p->l1 * a.c1 * v.x - p->l4 * a.c2 * v.y};
}

/* The curve and three derivatives at theta. */
static Local curve_at(const double *restrict table, double theta) {
  double c = cos(theta), s = sin(theta), basis[COLUMNS], sum[ROWS];
  basis[0] = 1;
  double ck = c, sk = s;
  for (int k = 1; k <= HARMONICS; ++k) {
    basis[k] = ck;
    basis[HARMONICS + k] = sk;
    double turned = c * ck - s * sk;
    sk = s * ck + c * sk;
    ck = turned;
  }
  for (int i = 0; i < ROWS; ++i) sum[i] = table[i];
  for (int k = 1; k < COLUMNS; ++k)
    for (int i = 0; i < ROWS; ++i) sum[i] += table[ROWS * k + i] * basis[k];
  return (Local){{sum[0], sum[1]}, {sum[2], sum[3]}, {sum[4], sum[5]}, {sum[6], sum[7]}};
}

/* The closest point to z by Newton on the curve's cubic polynomial; moves theta there. */
static Local project(Local at, Vec z, double *theta) {
  for (int i = 0; i < NEWTON_STEPS; ++i) {
    Vec gap = sub(at.sigma, z);
    double square = dot(at.first, at.first);
    double slope = fmax(square + dot(gap, at.second), 0.05 * square);
    double h = -clamp(dot(gap, at.first) / slope, -0.5, 0.5);
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
  double m12 = p->M12 * (a.c1 * a.c2 + a.s1 * a.s2), n12 = p->M12 * (a.s2 * a.c1 - a.c2 * a.s1);
  double f1 = tau.x - p->G1 * a.c1 - p->b1 * v.x + n12 * v.y * v.y;
  double f2 = tau.y - p->G2 * a.c2 - p->b2 * v.y - n12 * v.x * v.x;
  double inverse = 1 / (p->M11 * p->M22 - m12 * m12);
  return (Vec){inverse * (p->M22 * f1 - m12 * f2), inverse * (p->M11 * f2 - m12 * f1)};
}

/* Torques that give the end-point the acceleration a_y, if the model is right. */
static Vec torques(const Plant *p, Angles a, Vec v, Vec a_y) {
  double l1 = p->l1, l4 = p->l4, v1v1 = v.x * v.x, v2v2 = v.y * v.y;
  Vec b = {a_y.x + l1 * a.c1 * v1v1 - l4 * a.c2 * v2v2,
           a_y.y + l1 * a.s1 * v1v1 - l4 * a.s2 * v2v2};
  double sine = a.s1 * a.c2 - a.c1 * a.s2, cosine = a.c1 * a.c2 + a.s1 * a.s2;
  double w1 = -(a.c2 * b.x + a.s2 * b.y) / (l1 * sine);
  double w2 = -(a.c1 * b.x + a.s1 * b.y) / (l4 * sine);
  double m12 = p->M12 * cosine, n12 = -p->M12 * sine;
  return (Vec){p->M11 * w1 + m12 * w2 + p->G1 * a.c1 + p->b1 * v.x - n12 * v2v2,
               m12 * w1 + p->M22 * w2 + p->G2 * a.c2 + p->b2 * v.y + n12 * v1v1};
}

static Vec pushes(const Settings *s, Vec y, Vec y_rate) {
  Vec hand = along(scaled(300, sub(s->hand_target, y)), -10, y_rate);
  double size = sqrt(dot(hand, hand) + 1e-12);
  double brake = 2000 * dot(s->hold_tangent, sub(y, s->hold_anchor))
               + 40 * dot(s->hold_tangent, y_rate);
  hand = scaled(s->hand_active * (size > 15 ? 15 / size : 1), hand);
  return along(hand, -s->hold_active * clamp(brake, -30, 30), s->hold_tangent);
}

static void integrate(const Plant *p, Vec *q, Vec *v, Vec tau, double h) {
  Vec a1 = acceleration(p, *q, *v, tau);
  Vec v2 = along(*v, h / 2, a1), a2 = acceleration(p, along(*q, h / 2, *v), v2, tau);
  Vec v3 = along(*v, h / 2, a2), a3 = acceleration(p, along(*q, h / 2, v2), v3, tau);
  Vec v4 = along(*v, h, a3), a4 = acceleration(p, along(*q, h, v3), v4, tau);
  *q = along(*q, h / 6, add(add(*v, v4), scaled(2, add(v2, v3))));
  *v = along(*v, h / 6, add(add(a1, a4), scaled(2, add(a2, a3))));
}

/* Commanded y'' in the frame of the closest point: z = sigma + lambda N, differentiated twice. */
static Vec command(const Settings *s, const State *x, Local at, double theta, Vec z, Vec z_rate,
                   Row *row) {
  double length = sqrt(dot(at.first, at.first));
  Vec T = scaled(1 / length, at.first), N = {-T.y, T.x};
  double lambda = dot(N, sub(z, at.sigma)), lambda_rate = dot(N, z_rate);
  double stretch = dot(T, at.second), curvature = dot(N, at.second) / (length * length);
  double bent = 1 - lambda * curvature, g = length * bent;
  double theta_rate = dot(T, z_rate) / g, turn = curvature * length * theta_rate;
  double curving = dot(N, at.third) / (length * length) - 3 * curvature * stretch / length;
  double g_rate = theta_rate * (stretch * bent - length * lambda * curving)
                - length * lambda_rate * curvature;
  double across = -s->K1 * lambda - s->K2 * lambda_rate - s->K3 * x->integral.x;
  double onward = s->position != 0 ? -s->K4 * wrap(theta - s->target) - s->K5 * theta_rate
                                   : s->K5 * (s->speed - theta_rate);
  row->theta = theta, row->theta_rate = theta_rate;
  row->xi = lambda, row->xi_rate = lambda_rate;
  Vec tangential = scaled(g * onward + g_rate * theta_rate - lambda_rate * turn, T);
  return along(tangential, across + g * theta_rate * turn, N);
}

static void tick(const Settings *s, const double *table, State *x, Row *row) {
  double half = s->dt / 2;
  Vec gain = scaled(half, acceleration(&s->model, x->q, x->v, x->u));
  Vec q = along(x->q, half, along(x->v, 0.5, gain)), v = add(x->v, gain);
  Angles a = angles(q);
  Vec z = tip(&s->model, a), z_rate = tip_rate(&s->model, a, v);
  double theta = x->theta + s->dt * x->theta_rate;
  Local at = project(curve_at(table, theta), z, &theta);
  Vec wanted = torques(&s->model, a, v, command(s, x, at, theta, z, z_rate, row));

  double length = sqrt(dot(at.first, at.first));
  double bend = (at.first.x * at.second.y - at.first.y * at.second.x) / (length * length * length);
  double now = dot(at.first, tip_rate(&s->model, a, x->v))
             / (length * length * (1 - row->xi * bend));

  double limit = s->torque_limit;
  int acts = x->phase < 0.5;
  int saturated = fmax(fabs(wanted.x), fabs(wanted.y)) > limit;
  Vec u = acts ? (Vec){clamp(wanted.x, -limit, limit), clamp(wanted.y, -limit, limit)} : x->u;

  a = angles(x->q);
  Vec y = tip(&s->plant, a), force = pushes(s, y, tip_rate(&s->plant, a, x->v));
  Vec tau = {s->plant.l1 * (a.c1 * force.y - a.s1 * force.x)
                 + u.x - s->coulomb * x->v.x / sqrt(x->v.x * x->v.x + 0.0025),
             s->plant.l4 * (a.s2 * force.x - a.c2 * force.y)
                 + u.y - s->coulomb * x->v.y / sqrt(x->v.y * x->v.y + 0.0025)};
  row->q = x->q, row->v = x->v, row->y = y, row->theta_ref = x->theta_ref;
  row->u = u, row->force = force;

  integrate(&s->plant, &x->q, &x->v, tau, s->dt);
  if (acts && !saturated && s->hold_active == 0)
    x->integral.x += s->dt * s->hold_ticks * row->xi;
  if (s->K3 == 0) x->integral = (Vec){0, 0};
  double top = fabs(s->speed), gap = wrap(s->target - x->theta_ref) / s->dt;
  x->theta_ref += s->dt * (s->position != 0 ? clamp(gap, -top, top) : s->speed);
  x->theta = theta, x->theta_rate = row->theta_rate;
  row->speed = now * (length - half * now * dot(at.first, at.second) / length);
  row->theta_rate = now, row->theta -= half * now, row->xi -= half * row->xi_rate;
  x->encoder = row->q, x->encoder_rate = row->v, x->u = u;
  x->phase = x->phase + 1 < s->hold_ticks - 0.5 ? x->phase + 1 : 0;
}

static void run(const Settings *settings, const double *table, State *state, Row *log,
                long long ticks) {
  State x = *state;
  for (long long k = 0; k < ticks; ++k) tick(settings, table, &x, log + k);
  *state = x;
}

void onpath_run(const double *settings, const double *tables, double *states, double *logs,
                long long ticks, long long robots) {
  for (long long i = 0; i < robots; ++i)
    run((const Settings *)settings + i, tables + ROWS * COLUMNS * i, (State *)states + i,
        (Row *)logs + ticks * i, ticks);
}
