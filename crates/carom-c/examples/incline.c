/* An elastic block slides down an incline with friction: on a steep one ever faster, on a shallow one to a stop.
 *
 * The finite element code is the first half of this file: a cube of eight masses, each joined to each by a spring,
 * and a dense matrix with its Cholesky factor. Contact is the second half.
 */
#include <carom.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { NODES = 8, UNKNOWNS = 3 * NODES };

static const double MASS = 1.0, SPRING = 1e4, GRAVITY = 9.81, FRICTION = 0.3; /* of a node [kg], [N/m], [m/s2] */
static const double SPEED = 1.0, TIME_STEP = 1e-3;                           /* [m/s], [s] */

static double stiffness[UNKNOWNS][UNKNOWNS], factor[UNKNOWNS][UNKNOWNS];

/* K of springs between all nodes. */
static void assemble(double points[NODES][3]) {
  for (int i = 0; i < UNKNOWNS; i++)
    for (int j = 0; j < UNKNOWNS; j++) stiffness[i][j] = 0.0;
  for (int a = 0; a < NODES; a++)
    for (int b = 0; b < a; b++) {
      double along[3], square = 0.0;
      for (int i = 0; i < 3; i++) {
        along[i] = points[a][i] - points[b][i];
        square += along[i] * along[i];
      }
      for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
          double k = SPRING * along[i] * along[j] / square;
          stiffness[3 * a + i][3 * a + j] += k;
          stiffness[3 * b + i][3 * b + j] += k;
          stiffness[3 * a + i][3 * b + j] -= k;
          stiffness[3 * b + i][3 * a + j] -= k;
        }
    }
}

/* The lower Cholesky factor of M / dt^2 + K, by the implicit Euler method: vibrations die away. */
static void factorise(void) {
  for (int i = 0; i < UNKNOWNS; i++)
    for (int j = 0; j <= i; j++) {
      double sum = stiffness[i][j] + (i == j ? MASS / (TIME_STEP * TIME_STEP) : 0.0);
      for (int k = 0; k < j; k++) sum -= factor[i][k] * factor[j][k];
      factor[i][j] = i == j ? sqrt(sum) : sum / factor[j][j];
    }
}

static int solve(void *context, size_t unknowns, size_t columns, const double *b, double *x) {
  (void)context;
  for (size_t column = 0; column < columns; column++, b += unknowns, x += unknowns) {
    for (int i = 0; i < UNKNOWNS; i++) {
      x[i] = b[i];
      for (int k = 0; k < i; k++) x[i] -= factor[i][k] * x[k];
      x[i] /= factor[i][i];
    }
    for (int i = UNKNOWNS - 1; i >= 0; i--) {
      for (int k = i + 1; k < UNKNOWNS; k++) x[i] -= factor[k][i] * x[k];
      x[i] /= factor[i][i];
    }
  }
  return 0;
}

static void internal_force(const double *u, double *out) {
  for (int i = 0; i < UNKNOWNS; i++) {
    out[i] = 0.0;
    for (int j = 0; j < UNKNOWNS; j++) out[i] += stiffness[i][j] * u[j];
  }
}

static void check(enum carom_status status) {
  if (status != CAROM_STATUS_OK) {
    fprintf(stderr, "%s\n", carom_last_error());
    exit(status);
  }
}

/* Contact of the sides of the cube with the plane of the incline. */
static carom_contact *touching(double points[NODES][3], const double *normal) {
  static const int32_t sides[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
  static const double origin[3] = {0.0, 0.0, 0.0};
  carom_setup *setup;
  carom_contact *contact;
  check(carom_setup_new(3, points[0], NODES, &setup));
  check(carom_setup_surface(setup, "block", sides[0], 6, 4, 0));
  check(carom_setup_plane(setup, "incline", origin, normal));
  check(carom_setup_number(setup, "friction", FRICTION));
  check(carom_setup_number(setup, "theta", 1.0));
  check(carom_setup_build(setup, &contact));
  carom_setup_free(setup);
  return contact;
}

/* Slides for some steps down a slope [rad]; whether it went as it has to. */
static int slide(double slope, int steps) {
  const double down[3] = {cos(slope), 0.0, -sin(slope)}, normal[3] = {sin(slope), 0.0, cos(slope)};
  double points[NODES][3], at[NODES][3];
  double u[UNKNOWNS] = {0.0}, v[UNKNOWNS], d[UNKNOWNS], free_motion[UNKNOWNS], force[UNKNOWNS];
  for (int n = 0; n < NODES; n++)
    for (int i = 0; i < 3; i++) {
      points[n][i] = (n & 1) * down[i] + (n >> 1 & 1) * (i == 1) + (n >> 2) * normal[i];
      v[3 * n + i] = SPEED * down[i];
    }
  assemble(points);
  factorise();
  carom_contact *contact = touching(points, normal);
  double initial = 0.5 * NODES * MASS * SPEED * SPEED, total = 0.0, path = 0.0, speed[2] = {0.0, 0.0};
  carom_step done;
  carom_ledger ledger;

  for (int step = 1; step <= steps; step++) {
    for (int k = 0; k < UNKNOWNS; k++) at[k / 3][k % 3] = points[k / 3][k % 3] + u[k];
    check(carom_contact_search(contact, at[0], v, NODES, TIME_STEP, 0.0));

    internal_force(u, force);
    for (int k = 0; k < UNKNOWNS; k++) {
      force[k] = MASS * v[k] / TIME_STEP - force[k] - (k % 3 == 2 ? MASS * GRAVITY : 0.0);
      d[k] = TIME_STEP * v[k];
    }
    solve(NULL, UNKNOWNS, 1, force, free_motion);
    int missed = 1;
    while (missed) {
      /* All is linear, gaps too: once is enough. */
      for (int k = 0; k < UNKNOWNS; k++) at[k / 3][k % 3] = points[k / 3][k % 3] + u[k] + d[k];
      check(carom_contact_evaluate(contact, at[0], NODES));
      check(carom_contact_solve(contact, free_motion, UNKNOWNS, solve, NULL, d));
      for (int k = 0; k < UNKNOWNS; k++) at[k / 3][k % 3] = points[k / 3][k % 3] + u[k] + d[k];
      check(carom_contact_missed(contact, at[0], NODES, &missed));
    }
    check(carom_contact_accept(contact, at[0], NODES, &done));
    check(carom_contact_ledger(contact, &ledger));

    double kinetic = 0.0, potential = 0.0;
    path = speed[0] = speed[1] = 0.0;
    for (int k = 0; k < UNKNOWNS; k++) {
      u[k] += d[k];
      v[k] = d[k] / TIME_STEP;
    }
    internal_force(u, force);
    for (int k = 0; k < UNKNOWNS; k++) {
      kinetic += 0.5 * MASS * v[k] * v[k];
      potential += 0.5 * u[k] * force[k] + (k % 3 == 2 ? MASS * GRAVITY * u[k] : 0.0);
      path += u[k] * down[k % 3] / NODES;
      speed[0] += v[k] * down[k % 3] / NODES;
      speed[1] += v[k] * normal[k % 3] / NODES;
    }
    total = kinetic + potential + ledger.work.friction + ledger.work.normal_contact;
    if (step % 50 == 0)
      printf("%.17g %.17g %.17g %.17g %.17g %.17g\n", ledger.time, kinetic, potential, ledger.work.friction,
             ledger.work.normal_contact, path);
  }
  carom_contact_free(contact);

  double brake = GRAVITY * (FRICTION * cos(slope) - sin(slope)), expected, found;
  if (brake > 0.0) {
    expected = 0.5 * SPEED * SPEED / brake;
    found = path;
  } else {
    /* Momentum along the incline; nodes that also go sideways are braked less. */
    expected = SPEED - brake * steps * TIME_STEP;
    found = speed[0] + FRICTION * speed[1];
  }
  fprintf(stderr, "slope %.2f: %.10f, expected %.10f; the scheme took %.1e of the energy\n", slope, found, expected,
          1.0 - total / initial);
  return fabs(found - expected) < (brake > 0.0 ? 1e-2 : 1e-5) * expected && total < initial && total > 0.99 * initial;
}

int main(void) { return slide(0.5, 500) && slide(0.1, 700) ? 0 : 1; }
