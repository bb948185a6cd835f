/* Two elastic bars meet, exchange their velocities and part.
 *
 * The finite element code is the first half of this file: bars of linear elements whose motion is along x,
 * two rows of nodes each, and a tridiagonal matrix. Contact is the second half.
 */
#include <carom.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { CELLS = 20, NODES = 4 * (CELLS + 1) };

static const double LENGTH = 1.0, HEIGHT = 0.1, YOUNG = 1e4, DENSITY = 1.0; /* [m], [Pa], [kg/m3] */
static const double SPEED = 1.0, GAP = 1e-3, TIME_STEP = 2.5e-4;            /* [m/s], [m], [s] */

/* Node (bar, i, row) with i from left to right; its one unknown has the same number. */
static int node(int bar, int i, int row) { return 2 * (bar * (CELLS + 1) + i) + row; }

static double mass[NODES];

static double spring(void) { return YOUNG * 0.5 * HEIGHT / (LENGTH / CELLS); }

/* out = K u */
static void internal_force(const double *u, double *out) {
  for (int n = 0; n < NODES; n++) out[n] = 0.0;
  for (int bar = 0; bar < 2; bar++)
    for (int i = 0; i < CELLS; i++)
      for (int row = 0; row < 2; row++) {
        int a = node(bar, i, row), b = node(bar, i + 1, row);
        double pull = spring() * (u[b] - u[a]);
        out[a] -= pull;
        out[b] += pull;
      }
}

/* Solves with 2 M / dt^2 + K / 2, row of nodes by row of nodes. */
static int solve(void *context, size_t unknowns, size_t columns, const double *b, double *x) {
  (void)context;
  for (size_t column = 0; column < columns; column++, b += unknowns, x += unknowns)
    for (int bar = 0; bar < 2; bar++)
      for (int row = 0; row < 2; row++) {
        double k = spring(), pivot[CELLS + 1];
        for (int i = 0; i <= CELLS; i++) {
          int n = node(bar, i, row);
          pivot[i] = 2.0 * mass[n] / (TIME_STEP * TIME_STEP) + (i == 0 || i == CELLS ? 0.5 : 1.0) * k;
          x[n] = b[n];
          if (i > 0) {
            double factor = 0.5 * k / pivot[i - 1];
            pivot[i] -= 0.5 * k * factor;
            x[n] += factor * x[node(bar, i - 1, row)];
          }
        }
        for (int i = CELLS; i >= 0; i--) {
          int n = node(bar, i, row);
          if (i < CELLS) x[n] += 0.5 * k * x[node(bar, i + 1, row)];
          x[n] /= pivot[i];
        }
      }
  return 0;
}

static void check(enum carom_status status) {
  if (status != CAROM_STATUS_OK) {
    fprintf(stderr, "%s\n", carom_last_error());
    exit(status);
  }
}

/* Contact of two closed outlines; y is prescribed, as -1 says. */
static carom_contact *outlines(const double *points) {
  int32_t facets[2 * CELLS + 2][2], unknowns[NODES][2];
  for (int n = 0; n < NODES; n++) unknowns[n][0] = n, unknowns[n][1] = -1;
  carom_setup *setup;
  carom_contact *contact;
  check(carom_setup_new(2, points, NODES, &setup));
  for (int bar = 0; bar < 2; bar++) {
    for (int i = 0; i < CELLS; i++)
      for (int row = 0; row < 2; row++) {
        facets[2 * i + row][0] = node(bar, i, row);
        facets[2 * i + row][1] = node(bar, i + 1, row);
      }
    for (int end = 0; end < 2; end++)
      for (int row = 0; row < 2; row++) facets[2 * CELLS + end][row] = node(bar, end * CELLS, row);
    check(carom_setup_surface(setup, bar ? "right" : "left", facets[0], 2 * CELLS + 2, 2, 0));
  }
  check(carom_setup_unknowns(setup, unknowns[0], NODES, NODES));
  check(carom_setup_build(setup, &contact));
  carom_setup_free(setup);
  return contact;
}

static void place(const double *points, const double *u, const double *d, double (*at)[2]) {
  for (int n = 0; n < NODES; n++) at[n][0] = points[2 * n] + u[n] + d[n], at[n][1] = points[2 * n + 1];
}

int main(void) {
  static double points[NODES][2], at[NODES][2], velocity[NODES][2];
  static double u[NODES], v[NODES], d[NODES], free_motion[NODES], force[NODES], rest[NODES];
  for (int bar = 0; bar < 2; bar++)
    for (int i = 0; i <= CELLS; i++)
      for (int row = 0; row < 2; row++) {
        int n = node(bar, i, row);
        points[n][0] = bar * (LENGTH + GAP) + i * (LENGTH / CELLS);
        points[n][1] = row * HEIGHT;
        v[n] = bar ? -SPEED : SPEED;
        mass[n] = (i == 0 || i == CELLS ? 0.5 : 1.0) * DENSITY * 0.5 * HEIGHT * (LENGTH / CELLS);
      }
  carom_contact *contact = outlines(points[0]);
  double initial = DENSITY * LENGTH * HEIGHT * SPEED * SPEED, worst = 0.0;
  carom_ledger ledger;

  for (int step = 1; step <= 120; step++) {
    for (int n = 0; n < NODES; n++) velocity[n][0] = v[n];
    place(points[0], u, rest, at);
    check(carom_contact_search(contact, at[0], velocity[0], NODES, TIME_STEP, 0.0));

    internal_force(u, force);
    for (int n = 0; n < NODES; n++) {
      force[n] = 2.0 * mass[n] * v[n] / TIME_STEP - force[n];
      d[n] = TIME_STEP * v[n];
    }
    solve(NULL, NODES, 1, force, free_motion);
    int missed = 1;
    while (missed) {
      double correction = 1.0;
      for (int iteration = 0; correction > 1e-15 && iteration < 20; iteration++) {
        double before[NODES];
        for (int n = 0; n < NODES; n++) before[n] = d[n];
        place(points[0], u, d, at);
        check(carom_contact_evaluate(contact, at[0], NODES));
        check(carom_contact_solve(contact, free_motion, NODES, solve, NULL, d));
        correction = 0.0;
        for (int n = 0; n < NODES; n++) correction = fmax(correction, fabs(d[n] - before[n]));
      }
      place(points[0], u, d, at);
      check(carom_contact_missed(contact, at[0], NODES, &missed));
    }
    carom_step done;
    check(carom_contact_accept(contact, at[0], NODES, &done));
    check(carom_contact_ledger(contact, &ledger));

    double kinetic = 0.0, strain = 0.0;
    for (int n = 0; n < NODES; n++) {
      u[n] += d[n];
      v[n] = 2.0 * d[n] / TIME_STEP - v[n];
      kinetic += 0.5 * mass[n] * v[n] * v[n];
    }
    internal_force(u, force);
    for (int n = 0; n < NODES; n++) strain += 0.5 * u[n] * force[n];
    worst = fmax(worst, fabs(kinetic + strain + ledger.work.normal_contact - initial));
    if (step % 10 == 0) printf("%.17g %.17g %.17g %.17g\n", ledger.time, kinetic, strain, ledger.work.normal_contact);
  }

  double momentum[2] = {0.0, 0.0};
  for (int n = 0; n < NODES; n++) momentum[n >= NODES / 2] += mass[n] * v[n];
  double mean = momentum[0] / (DENSITY * LENGTH * HEIGHT);
  carom_contact_free(contact);
  fprintf(stderr, "the left bar leaves with %.4f m/s; the books close to %.1e of the energy\n", mean, worst / initial);
  int is_right = fabs(momentum[0] + momentum[1]) < 1e-14 && mean < -0.9 * SPEED && worst < 1e-12 * initial;
  return is_right ? 0 : 1;
}
