/* $title: see $header. Made by OnPath $version */

#include "$header"

#include <math.h>
#include <stddef.h>

enum {
    ROWS = $rows,       /* of a path's table: numbers of a point, and of its derivatives in a series */
    TERMS = $terms,     /* of the basis in each column */
    COLUMNS = $columns, /* places at which the path is evaluated */
    NUMBERS = $numbers, /* a point and its derivatives */
    GRID = $grid,       /* points of the path from which the search for the closest one begins */
    REFINEMENTS = $refinements,
    RAISED = $raised_count /* links between strokes, the most of a path */
};

static const double paths[${upper}_PATHS][$table_size] = $tables;

/* From which theta to which the pen is up; the rest is no number. */
static const double raised[${upper}_PATHS][RAISED][2] = $raised;

static const ${name}_settings settings_of[${upper}_PATHS] = $defaults;

$functions

/* sigma and its derivatives at the places of a tick, a column for each. */
static void evaluate(const ${name}_controller *c, const ${name}_state *state, double *values)
{
    double basis[COLUMNS * TERMS];
$evaluation
}

void ${name}_init(${name}_controller *c)
{
    const double rest[${upper}_COORDINATES] = {0.0};

    c->settings = settings_of[0];
    c->path = paths[0];
    c->raised = raised[0];
    begin(&c->state, 0.0, rest, rest, 0.0);
    c->state.code = ${upper}_NOT_STARTED;
}

double ${name}_closest(const ${name}_controller *c, const double q[${upper}_COORDINATES])
{
    ${name}_state at = c->state;
    double values[COLUMNS * NUMBERS], better, squared, least = INFINITY, theta = 0.0;
    int i;

    at.theta_rate = 0.0;
    for (i = 0; i < GRID; i++) {
        at.theta = $first + $spacing * i;
        evaluate(c, &at, values);
        closer(&c->settings, values, at.theta, q, &better, &squared);
        if (squared < least) {
            least = squared;
            theta = at.theta;
        }
    }
    for (i = 0; i < REFINEMENTS; i++) {
        at.theta = theta;
        evaluate(c, &at, values);
        closer(&c->settings, values, theta, q, &theta, &squared);
    }
    return theta;
}

void ${name}_start(${name}_controller *c, double t, const double q[${upper}_COORDINATES], const double *v,
                   double theta)
{
    const double rest[${upper}_COORDINATES] = {0.0};

    begin(&c->state, t, q, v != NULL ? v : rest, theta);
}

int ${name}_step(${name}_controller *c, double t, const double q[${upper}_COORDINATES], const double *v,
                 double torque[${upper}_MOTORS])
{
    const double none[${upper}_COORDINATES] = {0.0};
    double values[COLUMNS * NUMBERS];
    int unseen = (int)due(&c->state, &c->settings, t);

    for (; unseen > 0; unseen--) {
        evaluate(c, &c->state, values);
        tick(&c->state, &c->settings, values, t, none, none, 0.0, 0.0, torque);
    }
    evaluate(c, &c->state, values);
    tick(&c->state, &c->settings, values, t, q, v != NULL ? v : none, 1.0, v != NULL ? 1.0 : 0.0,
         torque);
    return (int)c->state.code;
}

void ${name}_stop(${name}_controller *c)
{
    if (c->state.code == ${upper}_OK) {
        c->state.code = ${upper}_STOPPED;
    }
}

void ${name}_follow(${name}_controller *c, int path)
{
    if (path < 0 || path >= ${upper}_PATHS) {
        return;
    }
    c->path = paths[path];
    c->raised = raised[path];
$following    c->state.theta = ${name}_closest(c, c->state.q);
    c->state.theta_ref = c->state.theta;
}

int ${name}_draws(const ${name}_controller *c)
{
    int i;

    for (i = 0; i < RAISED; i++) {
        if (c->raised[i][0] < c->state.theta && c->state.theta < c->raised[i][1]) {
            return 0;
        }
    }
    return 1;
}
