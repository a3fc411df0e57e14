/* A test of $source: it replays runs that OnPath recorded, and compares the torques.

       cc -std=c99 -O2 $source $replay -lm && ./a.out

   It prints the largest difference, and returns 0 if that is at most 1e-9 of the range of the
   torques; with the same C library and without contraction there is none. */

#include "$header"

#include <math.h>
#include <stddef.h>
#include <stdio.h>

enum { N = ${upper}_COORDINATES, M = ${upper}_MOTORS, SEGMENT = $segment };

$runs

/* states: NULL, or those of the controller after every SEGMENT steps, with which it goes on. */
static int replay(const char *what, const double (*rows)[1 + 2 * N + M], int count,
                  const ${name}_state *states, int has_v, double theta)
{
    ${name}_controller c;
    double torque[M], largest = 0.0, range = 0.0, share;
    int i, j;

    ${name}_init(&c);
    ${name}_start(&c, rows[0][0], rows[0] + 1, rows[0] + 1 + N, theta);
    for (i = 1; i < count; i++) {
        const double *row = rows[i];
        int code;

        if (states != NULL && i > SEGMENT && i % SEGMENT == 1) {
            c.state = states[i / SEGMENT - 1];
        }
        code = ${name}_step(&c, row[0], row + 1, has_v ? row + 1 + N : NULL, torque);
        if (code != ${upper}_OK) {
            printf("%s: refused in row %d with code %d\n", what, i, code);
            return 1;
        }
        for (j = 0; j < M; j++) {
            const double wanted = row[1 + 2 * N + j];
            largest = fmax(largest, isnan(torque[j]) ? INFINITY : fabs(torque[j] - wanted));
            range = fmax(range, fabs(wanted));
        }
    }
    share = largest / range;
    printf("%s: %d steps, torques of up to %g, largest difference %g (%g of the range): %s\n", what,
           count - 1, range, largest, share,
           largest <= 0.0 ? "equal to the last bit" : share <= 1e-9 ? "within 1e-9" : "WRONG");
    return share <= 1e-9 ? 0 : 1;
}

int main(void)
{
    int wrong = 0;

$calls
    return wrong;
}
