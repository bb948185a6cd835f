! carom: exact frictional contact in time loops of your own.
!
! Written by `python tools/make_fortran.py` from carom.h, whose comments say what holds of all
! calls; do not edit.
!
! Texts end with c_null_char. nodes and unknowns are numbered from 0. An array of shape
! [a][b] in C is one of shape (b, a) here: points have shape (dimension, point_count), and of frames
! the column (:, 1, i) is the normal. A solver is c_funloc of a function with the interface
! `carom_solver`.
module carom
  use, intrinsic :: iso_c_binding
  implicit none
  public
  integer(c_int), parameter :: CAROM_STATUS_OK = 0
  integer(c_int), parameter :: CAROM_STATUS_INVALID = 2
  integer(c_int), parameter :: CAROM_STATUS_NOT_CONVERGED = 3
  integer(c_int), parameter :: CAROM_STATUS_SOLVER_FAILED = 4
  integer(c_int), parameter :: CAROM_STATUS_BUSY = 5
  integer(c_int), parameter :: CAROM_STATUS_DEFECT = 6

  !> What reactions did [J].
  type, bind(c) :: carom_work
    real(c_double) :: friction
    real(c_double) :: normal_contact
    real(c_double) :: prescribed
  end type carom_work

  !> What a step came to.
  type, bind(c) :: carom_step
    type(carom_work) :: work
    real(c_double) :: certificate
    real(c_double) :: min_gap
    integer(c_size_t) :: pressing
  end type carom_step

  !> What the friction solver says about its answer.
  type, bind(c) :: carom_report
    real(c_double) :: certificate
    real(c_double) :: residual
    integer(c_size_t) :: iterations
  end type carom_report

  !> The books of contact over all steps that were accepted. With kinetic and strain energy your own, energy
  !> is kept where their change, plus friction and normal_contact, less prescribed and the work of your loads,
  !> is zero.
  type, bind(c) :: carom_ledger
    type(carom_work) :: work
    real(c_double) :: certificate
    real(c_double) :: min_gap
    real(c_double) :: time
    integer(c_size_t) :: steps
  end type carom_ledger

  !> Find reactions r and motions w = W r + q of contacts that obey the laws of Signorini and Coulomb.
  !> Component 0 of a contact vector is normal.
  type, bind(c) :: carom_problem
    integer(c_size_t) :: dimension
    integer(c_size_t) :: contact_count
    type(c_ptr) :: compliance
    type(c_ptr) :: motion
    type(c_ptr) :: friction
  end type carom_problem

  !> How a contact problem is solved.
  type, bind(c) :: carom_method
    type(c_ptr) :: solver
    real(c_double) :: tolerance
    integer(c_size_t) :: max_iterations
  end type carom_method

  !> A map from reactions to forces by columns: H of carom_contact_map, or your own.
  type, bind(c) :: carom_map
    integer(c_size_t) :: unknown_count
    integer(c_size_t) :: column_count
    type(c_ptr) :: starts
    type(c_ptr) :: unknowns
    type(c_ptr) :: values
  end type carom_map

  abstract interface
    !> Solves K x = b for several right-hand sides with your symmetric, positive definite K; 0 says
    !> that solutions were found. Solutions are zero before. context is what was given with it.
    function carom_solver(context, unknowns, columns, right_hand_sides, solutions) bind(c)
      import
      type(c_ptr), value :: context
      integer(c_size_t), value :: unknowns, columns
      real(c_double), intent(in) :: right_hand_sides(unknowns, columns)
      real(c_double), intent(inout) :: solutions(unknowns, columns)
      integer(c_int) :: carom_solver
    end function
  end interface

  interface
    !> The version of carom, as "0.1.0".
    function carom_version() bind(c)
      import
      type(c_ptr) :: carom_version
    end function

    !> What the last call of this thread that returns a status has to say: what is wrong, with place and
    !> value, and what to do. Empty after CAROM_STATUS_OK. It is there until the next such call of this
    !> thread.
    function carom_last_error() bind(c)
      import
      type(c_ptr) :: carom_last_error
    end function

    !> Begins to describe contact. dimension is 2 or 3; points [m] has the places of all nodes without
    !> deformation, shape [point_count][dimension]. Nodes are numbered from 0. Free what is written to setup
    !> with carom_setup_free.
    function carom_setup_new(dimension, points, point_count, setup) bind(c)
      import
      integer(c_size_t), value :: dimension
      real(c_double), intent(in) :: points(*)
      integer(c_size_t), value :: point_count
      type(c_ptr), intent(out) :: setup
      integer(c_int) :: carom_setup_new
    end function

    !> Frees a setup; contacts that were built of it stay. Null is nothing.
    subroutine carom_setup_free(setup) bind(c)
      import
      type(c_ptr), value :: setup
    end subroutine

    !> Adds the boundary of a body, or the part of it that may touch: the nodes of its facets in VTK's order,
    !> shape [facet_count][nodes_per_facet], with 2 or 3 nodes each in the plane and 3, 4, 6, 8 or 9 in space.
    !> Facets may be turned either way. Called again with the same name it adds facets, so that there may be
    !> several kinds. self_contact says whether the body may touch itself.
    function carom_setup_surface(setup, name, facets, facet_count, nodes_per_facet, self_contact) bind(c)
      import
      type(c_ptr), value :: setup
      character(kind=c_char), intent(in) :: name(*)
      integer(c_int32_t), intent(in) :: facets(*)
      integer(c_size_t), value :: facet_count
      integer(c_size_t), value :: nodes_per_facet
      integer(c_int), value :: self_contact
      integer(c_int) :: carom_setup_surface
    end function

    !> Adds a rigid half space: a point of its plane [m], and a normal towards the free side, of any length.
    function carom_setup_plane(setup, name, point, normal) bind(c)
      import
      type(c_ptr), value :: setup
      character(kind=c_char), intent(in) :: name(*)
      real(c_double), intent(in) :: point(*)
      real(c_double), intent(in) :: normal(*)
      integer(c_int) :: carom_setup_plane
    end function

    !> Adds a rigid ball, in the plane a disc [m]; with cavity not 0 what is around it is rigid, and the
    !> inside is free.
    function carom_setup_sphere(setup, name, centre, radius, cavity) bind(c)
      import
      type(c_ptr), value :: setup
      character(kind=c_char), intent(in) :: name(*)
      real(c_double), intent(in) :: centre(*)
      real(c_double), value :: radius
      integer(c_int), value :: cavity
      integer(c_int) :: carom_setup_sphere
    end function

    !> Adds a rigid cylinder without ends, in space: a point and the direction of its axis, and its radius
    !> [m]. cavity as of a sphere.
    function carom_setup_cylinder(setup, name, point, axis, radius, cavity) bind(c)
      import
      type(c_ptr), value :: setup
      character(kind=c_char), intent(in) :: name(*)
      real(c_double), intent(in) :: point(*)
      real(c_double), intent(in) :: axis(*)
      real(c_double), value :: radius
      integer(c_int), value :: cavity
      integer(c_int) :: carom_setup_cylinder
    end function

    !> Adds a rigid box with sides along the axes [m], in the plane a rectangle: its corner with the smallest
    !> coordinates, and its sides.
    function carom_setup_box(setup, name, corner, size) bind(c)
      import
      type(c_ptr), value :: setup
      character(kind=c_char), intent(in) :: name(*)
      real(c_double), intent(in) :: corner(*)
      real(c_double), intent(in) :: size(*)
      integer(c_int) :: carom_setup_box
    end function

    !> Adds the inside of a polygon as an obstacle, in the plane: its corners in order [m], shape
    !> [point_count][2].
    function carom_setup_polygon(setup, name, points, point_count) bind(c)
      import
      type(c_ptr), value :: setup
      character(kind=c_char), intent(in) :: name(*)
      real(c_double), intent(in) :: points(*)
      integer(c_size_t), value :: point_count
      integer(c_int) :: carom_setup_polygon
    end function

    !> Adds what a closed surface of triangles encloses as an obstacle, in space: vertices [m] of shape
    !> [vertex_count][3], and the three vertices of every triangle, counter-clockwise as seen from outside,
    !> from 0.
    function carom_setup_triangles(setup, name, vertices, vertex_count, triangles, triangle_count) bind(c)
      import
      type(c_ptr), value :: setup
      character(kind=c_char), intent(in) :: name(*)
      real(c_double), intent(in) :: vertices(*)
      integer(c_size_t), value :: vertex_count
      integer(c_int32_t), intent(in) :: triangles(*)
      integer(c_size_t), value :: triangle_count
      integer(c_int) :: carom_setup_triangles
    end function

    !> Lets an obstacle move with a constant velocity [m/s].
    function carom_setup_velocity(setup, obstacle, velocity) bind(c)
      import
      type(c_ptr), value :: setup
      character(kind=c_char), intent(in) :: obstacle(*)
      real(c_double), intent(in) :: velocity(*)
      integer(c_int) :: carom_setup_velocity
    end function

    !> Sets a number: "friction", Coulomb's coefficient (0); "theta" of the time scheme, the weight of the new
    !> velocity in d = dt ((1 - theta) v + theta v_new) (0.5); "tolerance" of the friction solver (1e-12);
    !> "max_iterations" (10000).
    function carom_setup_number(setup, key, value) bind(c)
      import
      type(c_ptr), value :: setup
      character(kind=c_char), intent(in) :: key(*)
      real(c_double), value :: value
      integer(c_int) :: carom_setup_number
    end function

    !> Sets a word: "condition", where in time contact is ruled, "gap" (the default), "midpoint" or
    !> "endpoint"; "targets" are "smooth" (the default) or "faceted"; "discretisation" is "node-to-segment"
    !> (the default) or "mortar"; "sources" are "finer", "first", "second" or "both"; "solver" of friction is
    !> "auto" (the default) or one of those that the manual lists; "analysis" is "dynamic" (the default) or
    !> "static", for load steps without inertia.
    function carom_setup_text(setup, key, value) bind(c)
      import
      type(c_ptr), value :: setup
      character(kind=c_char), intent(in) :: key(*)
      character(kind=c_char), intent(in) :: value(*)
      integer(c_int) :: carom_setup_text
    end function

    !> Sets a number of one pair of surfaces or obstacles, which are there already: "friction", or "enabled",
    !> 0 or 1.
    function carom_setup_pair_number(setup, first, second, key, value) bind(c)
      import
      type(c_ptr), value :: setup
      character(kind=c_char), intent(in) :: first(*)
      character(kind=c_char), intent(in) :: second(*)
      character(kind=c_char), intent(in) :: key(*)
      real(c_double), value :: value
      integer(c_int) :: carom_setup_pair_number
    end function

    !> Sets a word of one pair: "sources" or "discretisation".
    function carom_setup_pair_text(setup, first, second, key, value) bind(c)
      import
      type(c_ptr), value :: setup
      character(kind=c_char), intent(in) :: first(*)
      character(kind=c_char), intent(in) :: second(*)
      character(kind=c_char), intent(in) :: key(*)
      character(kind=c_char), intent(in) :: value(*)
      integer(c_int) :: carom_setup_pair_text
    end function

    !> Numbers your unknowns: that of each point and component, shape [point_count][dimension], from 0 to
    !> unknown_count - 1; -1 where motion is prescribed. Nodes may share unknowns. Without this call component
    !> i of node n is dimension n + i.
    function carom_setup_unknowns(setup, unknowns, point_count, unknown_count) bind(c)
      import
      type(c_ptr), value :: setup
      integer(c_int32_t), intent(in) :: unknowns(*)
      integer(c_size_t), value :: point_count
      integer(c_size_t), value :: unknown_count
      integer(c_int) :: carom_setup_unknowns
    end function

    !> Makes contact as it has been described. Free what is written to contact with carom_contact_free.
    function carom_setup_build(setup, contact) bind(c)
      import
      type(c_ptr), value :: setup
      type(c_ptr), intent(out) :: contact
      integer(c_int) :: carom_setup_build
    end function

    !> Frees contact. Null is nothing.
    subroutine carom_contact_free(contact) bind(c)
      import
      type(c_ptr), value :: contact
    end subroutine

    !> Starts a step of length time_step [s], and finds what may touch in it. points [m] and velocity [m/s]
    !> have shape [point_count][dimension]: where all nodes are at the start, and how fast. reach [m] is how
    !> far around their way things are looked for; 0 is twice as far as anything moves. With a reach velocity
    !> may be null if nothing else needs it.
    function carom_contact_search(contact, points, velocity, point_count, time_step, reach) bind(c)
      import
      type(c_ptr), value :: contact
      real(c_double), intent(in) :: points(*)
      real(c_double), intent(in), optional :: velocity(*)
      integer(c_size_t), value :: point_count
      real(c_double), value :: time_step
      real(c_double), value :: reach
      integer(c_int) :: carom_contact_search
    end function

    !> Evaluates what takes part in the step where the points are thought to be at its end [m].
    function carom_contact_evaluate(contact, points, point_count) bind(c)
      import
      type(c_ptr), value :: contact
      real(c_double), intent(in) :: points(*)
      integer(c_size_t), value :: point_count
      integer(c_int) :: carom_contact_evaluate
    end function

    !> Solves for the reactions of the contacts that were evaluated last. free [m] is the motion d of your
    !> unknowns in the step without reactions, and motion [m] becomes that with them, d = free + K^-1 H r; the
    !> two may be the same array. The solver solves with your K, and is given context.
    function carom_contact_solve(contact, free, unknown_count, solver, context, motion) bind(c)
      import
      type(c_ptr), value :: contact
      real(c_double), intent(in) :: free(*)
      integer(c_size_t), value :: unknown_count
      type(c_funptr), value :: solver
      type(c_ptr), value :: context
      real(c_double), intent(inout) :: motion(*)
      integer(c_int) :: carom_contact_solve
    end function

    !> Takes reactions [N] that you have solved for yourself, for the contacts that were evaluated last: size
    !> numbers, dimension for each contact.
    function carom_contact_set_reactions(contact, reactions, size) bind(c)
      import
      type(c_ptr), value :: contact
      real(c_double), intent(in) :: reactions(*)
      integer(c_size_t), value :: size
      integer(c_int) :: carom_contact_set_reactions
    end function

    !> Writes 1 to missed if something went through its target that was not foreseen, where the points end up
    !> [m], and 0 if not. Ask in a step that has converged. After 1 it takes part: evaluate, and iterate on.
    function carom_contact_missed(contact, points, point_count, missed) bind(c)
      import
      type(c_ptr), value :: contact
      real(c_double), intent(in) :: points(*)
      integer(c_size_t), value :: point_count
      integer(c_int), intent(out) :: missed
      integer(c_int) :: carom_contact_missed
    end function

    !> Ends the step where the points are [m]: keeps its reactions for the next one, and books what they did.
    function carom_contact_accept(contact, points, point_count, step) bind(c)
      import
      type(c_ptr), value :: contact
      real(c_double), intent(in) :: points(*)
      integer(c_size_t), value :: point_count
      type(carom_step), intent(out) :: step
      integer(c_int) :: carom_contact_accept
    end function

    !> How many entries H has that are not trivially zero.
    function carom_contact_map_size(contact, entries) bind(c)
      import
      type(c_ptr), value :: contact
      integer(c_size_t), intent(out) :: entries
      integer(c_int) :: carom_contact_map_size
    end function

    !> Writes H, the map from reactions to the forces on your unknowns, by columns, dimension for each
    !> contact: starts [column_count + 1], and the unknowns and values of its entries. An unknown may be there
    !> several times in a column; its values add up. The motion of a contact is H^T d + offset.
    function carom_contact_map(contact, starts, column_count, unknowns, values, entries) bind(c)
      import
      type(c_ptr), value :: contact
      integer(c_size_t), intent(inout) :: starts(*)
      integer(c_size_t), value :: column_count
      integer(c_int32_t), intent(inout) :: unknowns(*)
      real(c_double), intent(inout) :: values(*)
      integer(c_size_t), value :: entries
      integer(c_int) :: carom_contact_map
    end function

    !> Writes how many contacts take part in the step.
    function carom_contact_count(contact, count) bind(c)
      import
      type(c_ptr), value :: contact
      integer(c_size_t), intent(out) :: count
      integer(c_int) :: carom_contact_count
    end function

    !> Writes the gap of every contact along its normal [m], negative where there is penetration, where in
    !> time the condition is written; size is the count.
    function carom_contact_gaps(contact, gaps, size) bind(c)
      import
      type(c_ptr), value :: contact
      real(c_double), intent(inout) :: gaps(*)
      integer(c_size_t), value :: size
      integer(c_int) :: carom_contact_gaps
    end function

    !> Writes the frame of every contact, shape [count][dimension][dimension]: rows normal, from target to
    !> source, and tangents.
    function carom_contact_frames(contact, frames, size) bind(c)
      import
      type(c_ptr), value :: contact
      real(c_double), intent(inout) :: frames(*)
      integer(c_size_t), value :: size
      integer(c_int) :: carom_contact_frames
    end function

    !> Writes Coulomb's coefficient of every contact.
    function carom_contact_friction(contact, friction, size) bind(c)
      import
      type(c_ptr), value :: contact
      real(c_double), intent(inout) :: friction(*)
      integer(c_size_t), value :: size
      integer(c_int) :: carom_contact_friction
    end function

    !> Writes what the motions of contacts have beside H^T d [m], shape [count][dimension]: what the condition
    !> makes of the gap, and prescribed motion.
    function carom_contact_offsets(contact, offsets, size) bind(c)
      import
      type(c_ptr), value :: contact
      real(c_double), intent(inout) :: offsets(*)
      integer(c_size_t), value :: size
      integer(c_int) :: carom_contact_offsets
    end function

    !> Writes the reactions as they are known [N], shape [count][dimension], component 0 normal.
    function carom_contact_reactions(contact, reactions, size) bind(c)
      import
      type(c_ptr), value :: contact
      real(c_double), intent(inout) :: reactions(*)
      integer(c_size_t), value :: size
      integer(c_int) :: carom_contact_reactions
    end function

    !> Writes the source node of every contact; -1 of contacts between nodes.
    function carom_contact_nodes(contact, nodes, size) bind(c)
      import
      type(c_ptr), value :: contact
      integer(c_int32_t), intent(inout) :: nodes(*)
      integer(c_size_t), value :: size
      integer(c_int) :: carom_contact_nodes
    end function

    !> Writes the number of the pair of every contact, see carom_contact_pair_names.
    function carom_contact_pairs(contact, pairs, size) bind(c)
      import
      type(c_ptr), value :: contact
      integer(c_size_t), intent(inout) :: pairs(*)
      integer(c_size_t), value :: size
      integer(c_int) :: carom_contact_pairs
    end function

    !> Writes the forces of the reactions on your unknowns, H r [N].
    function carom_contact_force(contact, force, unknown_count) bind(c)
      import
      type(c_ptr), value :: contact
      real(c_double), intent(inout) :: force(*)
      integer(c_size_t), value :: unknown_count
      integer(c_int) :: carom_contact_force
    end function

    !> Writes what the friction solver said of the reactions that were last solved for; zeros without
    !> contacts.
    function carom_contact_report(contact, report) bind(c)
      import
      type(c_ptr), value :: contact
      type(carom_report), intent(out) :: report
      integer(c_int) :: carom_contact_report
    end function

    !> Writes the books since the start.
    function carom_contact_ledger(contact, ledger) bind(c)
      import
      type(c_ptr), value :: contact
      type(carom_ledger), intent(out) :: ledger
      integer(c_int) :: carom_contact_ledger
    end function

    !> Writes the names of a pair by its number, see carom_contact_pairs. They are there as long as contact
    !> is.
    function carom_contact_pair_names(contact, pair, first, second) bind(c)
      import
      type(c_ptr), value :: contact
      integer(c_size_t), value :: pair
      type(c_ptr), intent(out) :: first
      type(c_ptr), intent(out) :: second
      integer(c_int) :: carom_contact_pair_names
    end function

    !> Writes what the reactions between two surfaces, or a surface and an obstacle, did since the start.
    function carom_contact_pair_work(contact, first, second, work) bind(c)
      import
      type(c_ptr), value :: contact
      character(kind=c_char), intent(in) :: first(*)
      character(kind=c_char), intent(in) :: second(*)
      type(carom_work), intent(out) :: work
      integer(c_int) :: carom_contact_pair_work
    end function

    !> Solves a contact problem. reactions [N], shape [n][dimension], are a guess before and the answer after;
    !> zeros are a guess. method may be null, and report too.
    function carom_friction_solve(problem, method, reactions, report) bind(c)
      import
      type(carom_problem), intent(in) :: problem
      type(carom_method), intent(in), optional :: method
      real(c_double), intent(inout) :: reactions(*)
      type(carom_report), intent(out), optional :: report
      integer(c_int) :: carom_friction_solve
    end function

    !> Writes W = H^T K^-1 H [m/N], shape [column_count][column_count], by a solver of K.
    function carom_friction_condense(map, solver, context, compliance) bind(c)
      import
      type(carom_map), intent(in) :: map
      type(c_funptr), value :: solver
      type(c_ptr), value :: context
      real(c_double), intent(inout) :: compliance(*)
      integer(c_int) :: carom_friction_condense
    end function

  end interface

contains

  !> What the last call of this thread has to say, as a text of Fortran.
  function carom_message() result(text)
    character(:), allocatable :: text
    character(kind=c_char), pointer :: letters(:)
    type(c_ptr) :: said
    integer :: k

    said = carom_last_error()
    call c_f_pointer(said, letters, [huge(k)])
    k = 1
    do while (letters(k) /= c_null_char)
      k = k + 1
    end do
    allocate (character(k - 1) :: text)
    do k = 1, len(text)
      text(k:k) = letters(k)
    end do
  end function
end module
