/* $title

   Made by OnPath $version. Path: $path_names.
$guesses
   The controller computes torques of motors from what is measured:

       ${name}_controller c;
       ${name}_init(&c);
       ${name}_start(&c, t, q, v, ${name}_closest(&c, q));
       for (;;) {                             once in every control interval, or more often
           int code = ${name}_step(&c, t, q, v, torque);
           ...                                give the torque to the motors, whatever the code
       }

   Positions alone suffice: with NULL for v, $observer finds the velocities.

   All numbers are doubles in SI units; angles are in radians. t is the time of the measurement in
   seconds, of any clock that does not jump. It is counted in ticks of $tick s from the start.
   No heap, no input or output, no static data that changes: each ${name}_controller is on its own.
   Work: a tick takes $operations operations on numbers; a step takes one tick, and one for each
   tick that has passed without a step, at most 2 hold_ticks + 1 together. ${name}_closest takes
   $search.

   Compile with -std=c99, or with -ffp-contract=off: then the torques are OnPath's to the last
   bit, if the C library is the same.

   This is not a safety function. Nothing here has been certified, and it can be wrong. Around a
   real arm there must be a stop that cuts the power, and the maker's own limits of speed and
   force; keep out of its reach while it moves. */

#ifndef ${guard}
#define ${guard}

#ifdef __cplusplus
extern "C" {
#endif

#define ${upper}_COORDINATES $n /* $coordinates */
#define ${upper}_MOTORS $m /* $motors */
#define ${upper}_PATHS $paths /* $path_names */

/* Why a step was refused. From then on the torque is what at_fault chose, until ${name}_start. */
enum {
$codes
};

/* What may be changed between two steps. A change acts when the law is evaluated next. */
typedef struct {
$settings
} ${name}_settings;

/* What the controller remembers: read it, but leave it to the functions. */
typedef struct {
$state
} ${name}_state;

typedef struct {
    ${name}_settings settings;
    ${name}_state state;
    const double *path;
    const double (*raised)[2];
} ${name}_controller;

/* The settings as exported, the first path, and not started. */
void ${name}_init(${name}_controller *c);

/* theta of the point of the path that is closest to the end-point at q, by search. */
double ${name}_closest(const ${name}_controller *c, const double q[${upper}_COORDINATES]);

/* Start, or start again after a refusal, at rest or in motion.
   v: NULL if it is not measured; theta: see ${name}_closest. */
void ${name}_start(${name}_controller *c, double t, const double q[${upper}_COORDINATES], const double *v,
                   double theta);

/* The torques from a measurement at time t; the code.
   v: NULL if it is not measured; then $observer finds it. */
int ${name}_step(${name}_controller *c, double t, const double q[${upper}_COORDINATES], const double *v,
                 double torque[${upper}_MOTORS]);

/* Refuse all further steps, until ${name}_start: their torque is what at_fault chose. */
void ${name}_stop(${name}_controller *c);

/* Follow another of the exported paths from the next step on: from its point that is closest to
   the end-point of the last step. */
void ${name}_follow(${name}_controller *c, int path);

/* Whether the pen is down where the end-point is: 0 on a link between two strokes of a drawing. */
int ${name}_draws(const ${name}_controller *c);

#ifdef __cplusplus
}
#endif

#endif
