/* carom: exact frictional contact in time loops of your own.
 *
 * Written by `cargo run --release -p carom-c --example header`; do not edit.
 *
 * A step of your loop is carom_contact_search, then until your iterations have converged carom_contact_evaluate and carom_contact_solve, then
 * carom_contact_missed and carom_contact_accept. What there is and what may touch what is described before by carom_setup_...
 *
 * Every function but those that free returns a carom_status; carom_last_error() says what is wrong. Units are SI. Numbers of nodes, unknowns and contacts are from 0. Arrays of
 * shape [a][b] have the b numbers of the first row first.
 *
 * What has to hold of pointers: a handle is one that carom wrote and that was not freed; arrays have the sizes that are said, and nobody changes them during the call; texts end with a
 * zero; where something is written there is room for it, and nothing of the input lies there unless it says so. Null and sizes that do not fit
 * are refused. A handle serves one call at a time, and may go from one thread to another. Nothing is kept of what you give but copies.
 */

#ifndef CAROM_H
#define CAROM_H

#include <stddef.h>
#include <stdint.h>

/**
 * How a call ended. Of all but CAROM_STATUS_OK carom_last_error() says why, and nothing was written.
 */
typedef enum carom_status {
  /**
   * It did what it was asked for.
   */
  CAROM_STATUS_OK = 0,
  /**
   * A null pointer, a size that does not fit, a value out of range, or a call out of order.
   */
  CAROM_STATUS_INVALID = 2,
  /**
   * No reactions were found, or contacts were missed again and again. The step may be tried again from its search on.
   */
  CAROM_STATUS_NOT_CONVERGED = 3,
  /**
   * The caller's solver said that it failed.
   */
  CAROM_STATUS_SOLVER_FAILED = 4,
  /**
   * The handle is in use: by another thread, or by the call that is calling back.
   */
  CAROM_STATUS_BUSY = 5,
  /**
   * A defect of carom. The handle is of no more use; free it.
   */
  CAROM_STATUS_DEFECT = 6,
} carom_status;

/**
 * Contact in your time loop. It knows one step at a time: what it found, the reactions so far, and those of the step before, from which the next one starts.
 */
typedef struct carom_contact carom_contact;

/**
 * Bodies, obstacles and what may touch what, as they are described piece by piece.
 */
typedef struct carom_setup carom_setup;

/**
 * Solves K x = b for several right-hand sides with the caller's symmetric, positive definite K.
 *
 * `right_hand_sides` [N] and `solutions` [m] have `columns` columns of `unknowns` numbers each, one column after the other; solutions are zero before.
 * `context` is what was given with the function. 0 says that they were found, everything else that the solver failed. It must not call carom with
 * the handle that it is called for, and no exception or longjmp may leave it.
 */
typedef int (*carom_solver)(void *context,
                            size_t unknowns,
                            size_t columns,
                            const double *right_hand_sides,
                            double *solutions);

/**
 * What reactions did [J].
 */
typedef struct carom_work {
  /**
   * Taken by friction.
   */
  double friction;
  /**
   * Taken by normal reactions.
   */
  double normal_contact;
  /**
   * Work of what is prescribed: of obstacles that move, and of held unknowns that are pressed.
   */
  double prescribed;
} carom_work;

/**
 * What a step came to.
 */
typedef struct carom_step {
  /**
   * What all reactions did.
   */
  struct carom_work work;
  /**
   * Distance from the laws of contact and friction, the sum of the bi-potential gaps [J].
   */
  double certificate;
  /**
   * Smallest gap at the end among what took part [m]; infinite without contacts.
   */
  double min_gap;
  /**
   * How many contacts press.
   */
  size_t pressing;
} carom_step;

/**
 * What the friction solver says about its answer.
 */
typedef struct carom_report {
  /**
   * Distance from the laws, the sum of the bi-potential gaps [J].
   */
  double certificate;
  /**
   * Relative residual in the natural units of the problem.
   */
  double residual;
  /**
   * Iterations.
   */
  size_t iterations;
} carom_report;

/**
 * The books of contact over all steps that were accepted. With kinetic and strain energy your own, energy is kept where their change, plus friction and normal_contact, less
 * prescribed and the work of your loads, is zero.
 */
typedef struct carom_ledger {
  /**
   * What all reactions did.
   */
  struct carom_work work;
  /**
   * Largest distance of a step from the laws [J].
   */
  double certificate;
  /**
   * Smallest gap [m].
   */
  double min_gap;
  /**
   * Time [s].
   */
  double time;
  /**
   * Steps.
   */
  size_t steps;
} carom_ledger;

/**
 * Find reactions r and motions w = W r + q of contacts that obey the laws of Signorini and Coulomb. Component 0 of a contact vector is normal.
 */
typedef struct carom_problem {
  /**
   * Components of a contact vector: 1, 2 or 3.
   */
  size_t dimension;
  /**
   * How many contacts there are, n.
   */
  size_t contact_count;
  /**
   * W [m/N], symmetric and positive semidefinite, shape [n dimension][n dimension]; of its two halves that above the diagonal counts.
   */
  const double *compliance;
  /**
   * q [m], the motions without reactions, shape [n][dimension].
   */
  const double *motion;
  /**
   * Coulomb's coefficients, shape [n].
   */
  const double *friction;
} carom_problem;

/**
 * How a contact problem is solved.
 */
typedef struct carom_method {
  /**
   * The name of the solver; null is "auto".
   */
  const char *solver;
  /**
   * Relative residual at which it is solved; 0 is 1e-12.
   */
  double tolerance;
  /**
   * Iterations after which it fails; 0 is 10000.
   */
  size_t max_iterations;
} carom_method;

/**
 * A map from reactions to forces by columns: H of carom_contact_map, or your own.
 */
typedef struct carom_map {
  /**
   * How many unknowns there are.
   */
  size_t unknown_count;
  /**
   * How many columns.
   */
  size_t column_count;
  /**
   * Where each column starts, and the end of the last, shape [column_count + 1].
   */
  const size_t *starts;
  /**
   * The unknowns of the entries, from 0, shape [starts[column_count]].
   */
  const int32_t *unknowns;
  /**
   * Their values, of the same shape.
   */
  const double *values;
} carom_map;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * The version of carom, as "0.1.0".
 */
const char *carom_version(void);

/**
 * What the last call of this thread that returns a status has to say: what is wrong, with place and value, and what to do. Empty after CAROM_STATUS_OK. It is there until
 * the next such call of this thread.
 */
const char *carom_last_error(void);

/**
 * Begins to describe contact. dimension is 2 or 3; points [m] has the places of all nodes without deformation, shape [point_count][dimension]. Nodes are numbered
 * from 0. Free what is written to setup with carom_setup_free.
 */
enum carom_status carom_setup_new(size_t dimension,
                                  const double *points,
                                  size_t point_count,
                                  struct carom_setup **setup);

/**
 * Frees a setup; contacts that were built of it stay. Null is nothing.
 */
void carom_setup_free(struct carom_setup *setup);

/**
 * Adds the boundary of a body, or the part of it that may touch: the nodes of its facets in VTK's order, shape [facet_count][nodes_per_facet], with 2 or 3 nodes each in
 * the plane and 3, 4, 6, 8 or 9 in space. Facets may be turned either way. Called again with the same name it adds facets, so that there may be several
 * kinds. self_contact says whether the body may touch itself.
 */
enum carom_status carom_setup_surface(struct carom_setup *setup,
                                      const char *name,
                                      const int32_t *facets,
                                      size_t facet_count,
                                      size_t nodes_per_facet,
                                      int self_contact);

/**
 * Adds a rigid half space: a point of its plane [m], and a normal towards the free side, of any length.
 */
enum carom_status carom_setup_plane(struct carom_setup *setup,
                                    const char *name,
                                    const double *point,
                                    const double *normal);

/**
 * Adds a rigid ball, in the plane a disc [m]; with cavity not 0 what is around it is rigid, and the inside is free.
 */
enum carom_status carom_setup_sphere(struct carom_setup *setup,
                                     const char *name,
                                     const double *centre,
                                     double radius,
                                     int cavity);

/**
 * Adds a rigid cylinder without ends, in space: a point and the direction of its axis, and its radius [m]. cavity as of a sphere.
 */
enum carom_status carom_setup_cylinder(struct carom_setup *setup,
                                       const char *name,
                                       const double *point,
                                       const double *axis,
                                       double radius,
                                       int cavity);

/**
 * Adds a rigid box with sides along the axes [m], in the plane a rectangle: its corner with the smallest coordinates, and its sides.
 */
enum carom_status carom_setup_box(struct carom_setup *setup,
                                  const char *name,
                                  const double *corner,
                                  const double *size);

/**
 * Adds the inside of a polygon as an obstacle, in the plane: its corners in order [m], shape [point_count][2].
 */
enum carom_status carom_setup_polygon(struct carom_setup *setup,
                                      const char *name,
                                      const double *points,
                                      size_t point_count);

/**
 * Adds what a closed surface of triangles encloses as an obstacle, in space: vertices [m] of shape [vertex_count][3], and the three vertices of every triangle, counter-clockwise as
 * seen from outside, from 0.
 */
enum carom_status carom_setup_triangles(struct carom_setup *setup,
                                        const char *name,
                                        const double *vertices,
                                        size_t vertex_count,
                                        const int32_t *triangles,
                                        size_t triangle_count);

/**
 * Lets an obstacle move with a constant velocity [m/s].
 */
enum carom_status carom_setup_velocity(struct carom_setup *setup,
                                       const char *obstacle,
                                       const double *velocity);

/**
 * Sets a number: "friction", Coulomb's coefficient (0); "theta" of the time scheme, the weight of the new velocity in d = dt ((1 - theta) v + theta v_new) (0.5);
 * "tolerance" of the friction solver (1e-12); "max_iterations" (10000).
 */
enum carom_status carom_setup_number(struct carom_setup *setup,
                                     const char *key,
                                     double value);

/**
 * Sets a word: "condition", where in time contact is ruled, "gap" (the default), "midpoint" or "endpoint"; "targets" are "smooth" (the default) or "faceted"; "discretisation" is
 * "node-to-segment" (the default) or "mortar"; "sources" are "finer", "first", "second" or "both"; "solver" of friction is "auto" (the default) or one of those that the manual lists;
 * "analysis" is "dynamic" (the default) or "static", for load steps without inertia.
 */
enum carom_status carom_setup_text(struct carom_setup *setup,
                                   const char *key,
                                   const char *value);

/**
 * Sets a number of one pair of surfaces or obstacles, which are there already: "friction", or "enabled", 0 or 1.
 */
enum carom_status carom_setup_pair_number(struct carom_setup *setup,
                                          const char *first,
                                          const char *second,
                                          const char *key,
                                          double value);

/**
 * Sets a word of one pair: "sources" or "discretisation".
 */
enum carom_status carom_setup_pair_text(struct carom_setup *setup,
                                        const char *first,
                                        const char *second,
                                        const char *key,
                                        const char *value);

/**
 * Numbers your unknowns: that of each point and component, shape [point_count][dimension], from 0 to unknown_count - 1; -1 where motion is prescribed. Nodes may share unknowns.
 * Without this call component i of node n is dimension n + i.
 */
enum carom_status carom_setup_unknowns(struct carom_setup *setup,
                                       const int32_t *unknowns,
                                       size_t point_count,
                                       size_t unknown_count);

/**
 * Makes contact as it has been described. Free what is written to contact with carom_contact_free.
 */
enum carom_status carom_setup_build(struct carom_setup *setup, struct carom_contact **contact);

/**
 * Frees contact. Null is nothing.
 */
void carom_contact_free(struct carom_contact *contact);

/**
 * Starts a step of length time_step [s], and finds what may touch in it. points [m] and velocity [m/s] have shape [point_count][dimension]: where all nodes are at the start, and how fast.
 * reach [m] is how far around their way things are looked for; 0 is twice as far as anything moves. With a reach velocity may be null if nothing else needs it.
 */
enum carom_status carom_contact_search(struct carom_contact *contact,
                                       const double *points,
                                       const double *velocity,
                                       size_t point_count,
                                       double time_step,
                                       double reach);

/**
 * Evaluates what takes part in the step where the points are thought to be at its end [m].
 */
enum carom_status carom_contact_evaluate(struct carom_contact *contact,
                                         const double *points,
                                         size_t point_count);

/**
 * Solves for the reactions of the contacts that were evaluated last. free [m] is the motion d of your unknowns in the step without reactions, and motion [m] becomes that with them,
 * d = free + K^-1 H r; the two may be the same array. The solver solves with your K, and is given context.
 */
enum carom_status carom_contact_solve(struct carom_contact *contact,
                                      const double *free,
                                      size_t unknown_count,
                                      carom_solver solver,
                                      void *context,
                                      double *motion);

/**
 * Takes reactions [N] that you have solved for yourself, for the contacts that were evaluated last: size numbers, dimension for each contact.
 */
enum carom_status carom_contact_set_reactions(struct carom_contact *contact,
                                              const double *reactions,
                                              size_t size);

/**
 * Writes 1 to missed if something went through its target that was not foreseen, where the points end up [m], and 0 if not. Ask in a step that has converged. After 1 it takes part:
 * evaluate, and iterate on.
 */
enum carom_status carom_contact_missed(struct carom_contact *contact,
                                       const double *points,
                                       size_t point_count,
                                       int *missed);

/**
 * Ends the step where the points are [m]: keeps its reactions for the next one, and books what they did.
 */
enum carom_status carom_contact_accept(struct carom_contact *contact,
                                       const double *points,
                                       size_t point_count,
                                       struct carom_step *step);

/**
 * How many entries H has that are not trivially zero.
 */
enum carom_status carom_contact_map_size(const struct carom_contact *contact, size_t *entries);

/**
 * Writes H, the map from reactions to the forces on your unknowns, by columns, dimension for each contact: starts [column_count + 1], and the unknowns and values of its entries.
 * An unknown may be there several times in a column; its values add up. The motion of a contact is H^T d + offset.
 */
enum carom_status carom_contact_map(const struct carom_contact *contact,
                                    size_t *starts,
                                    size_t column_count,
                                    int32_t *unknowns,
                                    double *values,
                                    size_t entries);

/**
 * Writes how many contacts take part in the step.
 */
enum carom_status carom_contact_count(const struct carom_contact *contact, size_t *count);

/**
 * Writes the gap of every contact along its normal [m], negative where there is penetration, where in time the condition is written; size is the count.
 */
enum carom_status carom_contact_gaps(const struct carom_contact *contact,
                                     double *gaps,
                                     size_t size);

/**
 * Writes the frame of every contact, shape [count][dimension][dimension]: rows normal, from target to source, and tangents.
 */
enum carom_status carom_contact_frames(const struct carom_contact *contact,
                                       double *frames,
                                       size_t size);

/**
 * Writes Coulomb's coefficient of every contact.
 */
enum carom_status carom_contact_friction(const struct carom_contact *contact,
                                         double *friction,
                                         size_t size);

/**
 * Writes what the motions of contacts have beside H^T d [m], shape [count][dimension]: what the condition makes of the gap, and prescribed motion.
 */
enum carom_status carom_contact_offsets(const struct carom_contact *contact,
                                        double *offsets,
                                        size_t size);

/**
 * Writes the reactions as they are known [N], shape [count][dimension], component 0 normal.
 */
enum carom_status carom_contact_reactions(const struct carom_contact *contact,
                                          double *reactions,
                                          size_t size);

/**
 * Writes the source node of every contact; -1 of contacts between nodes.
 */
enum carom_status carom_contact_nodes(const struct carom_contact *contact,
                                      int32_t *nodes,
                                      size_t size);

/**
 * Writes the number of the pair of every contact, see carom_contact_pair_names.
 */
enum carom_status carom_contact_pairs(const struct carom_contact *contact,
                                      size_t *pairs,
                                      size_t size);

/**
 * Writes the forces of the reactions on your unknowns, H r [N].
 */
enum carom_status carom_contact_force(const struct carom_contact *contact,
                                      double *force,
                                      size_t unknown_count);

/**
 * Writes what the friction solver said of the reactions that were last solved for; zeros without contacts.
 */
enum carom_status carom_contact_report(const struct carom_contact *contact,
                                       struct carom_report *report);

/**
 * Writes the books since the start.
 */
enum carom_status carom_contact_ledger(const struct carom_contact *contact,
                                       struct carom_ledger *ledger);

/**
 * Writes the names of a pair by its number, see carom_contact_pairs. They are there as long as contact is.
 */
enum carom_status carom_contact_pair_names(const struct carom_contact *contact,
                                           size_t pair,
                                           const char **first,
                                           const char **second);

/**
 * Writes what the reactions between two surfaces, or a surface and an obstacle, did since the start.
 */
enum carom_status carom_contact_pair_work(const struct carom_contact *contact,
                                          const char *first,
                                          const char *second,
                                          struct carom_work *work);

/**
 * Solves a contact problem. reactions [N], shape [n][dimension], are a guess before and the answer after; zeros are a guess. method may be null, and report too.
 */
enum carom_status carom_friction_solve(const struct carom_problem *problem,
                                       const struct carom_method *method,
                                       double *reactions,
                                       struct carom_report *report);

/**
 * Writes W = H^T K^-1 H [m/N], shape [column_count][column_count], by a solver of K.
 */
enum carom_status carom_friction_condense(const struct carom_map *map,
                                          carom_solver solver,
                                          void *context,
                                          double *compliance);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* CAROM_H */
