! An elastic block slides down an incline with friction: on a steep one ever faster, on a shallow one to a stop.
! The same as incline.c, in Fortran.

! A finite element code: a cube of eight masses, each joined to each by a spring, and a dense matrix with its factor.
module block
  use, intrinsic :: iso_c_binding
  implicit none
  integer, parameter :: dp = c_double, nodes = 8, unknowns = 3 * nodes
  real(dp), parameter :: mass = 1, spring = 1e4_dp, gravity = 9.81_dp, mu = 0.3_dp ! of a node [kg], [N/m], [m/s2]
  real(dp), parameter :: speed = 1, time_step = 1e-3_dp ! [m/s], [s]
  real(dp) :: stiffness(unknowns, unknowns), factor(unknowns, unknowns)

contains

  ! K of springs between all nodes.
  subroutine assemble(points)
    real(dp), intent(in) :: points(3, nodes)
    real(dp) :: along(3), k(3, 3)
    integer :: a, b, i, p, q

    stiffness = 0
    do a = 1, nodes
      do b = 1, a - 1
        along = points(:, a) - points(:, b)
        do i = 1, 3
          k(:, i) = spring * along * along(i) / sum(along**2)
        end do
        p = 3 * a - 2
        q = 3 * b - 2
        stiffness(p:p + 2, p:p + 2) = stiffness(p:p + 2, p:p + 2) + k
        stiffness(q:q + 2, q:q + 2) = stiffness(q:q + 2, q:q + 2) + k
        stiffness(p:p + 2, q:q + 2) = stiffness(p:p + 2, q:q + 2) - k
        stiffness(q:q + 2, p:p + 2) = stiffness(q:q + 2, p:p + 2) - k
      end do
    end do
  end subroutine

  ! The lower Cholesky factor of M / dt^2 + K, by the implicit Euler method: vibrations die away.
  subroutine factorise()
    integer :: i, j
    real(dp) :: rest

    do i = 1, unknowns
      do j = 1, i
        rest = stiffness(i, j) - dot_product(factor(i, :j - 1), factor(j, :j - 1))
        if (i == j) then
          factor(i, i) = sqrt(rest + mass / time_step**2)
        else
          factor(i, j) = rest / factor(j, j)
        end if
      end do
    end do
  end subroutine

  function solve(context, count, columns, b, x) bind(c)
    type(c_ptr), value :: context
    integer(c_size_t), value :: count, columns
    real(dp), intent(in) :: b(count, columns)
    real(dp), intent(inout) :: x(count, columns)
    integer(c_int) :: solve
    integer :: i, column

    do column = 1, int(columns)
      do i = 1, unknowns
        x(i, column) = (b(i, column) - dot_product(factor(i, :i - 1), x(:i - 1, column))) / factor(i, i)
      end do
      do i = unknowns, 1, -1
        x(i, column) = (x(i, column) - dot_product(factor(i + 1:, i), x(i + 1:, column))) / factor(i, i)
      end do
    end do
    solve = merge(1, 0, c_associated(context))
  end function
end module

program incline
  use block
  use carom
  implicit none

  if (.not. slid(0.5_dp, 500)) error stop 1
  if (.not. slid(0.1_dp, 700)) error stop 1

contains

  subroutine check(status)
    integer(c_int), intent(in) :: status

    if (status == CAROM_STATUS_OK) return
    write (*, '(a)') carom_message()
    error stop 2
  end subroutine

  ! Contact of the sides of the cube with the plane of the incline. Nodes are numbered from 0.
  function touching(points, normal) result(contact)
    real(dp), intent(in) :: points(3, nodes), normal(3)
    integer(c_int32_t), parameter :: sides(4, 6) = reshape( &
      [0, 1, 3, 2, 4, 5, 7, 6, 0, 1, 5, 4, 2, 3, 7, 6, 0, 2, 6, 4, 1, 3, 7, 5], [4, 6])
    type(c_ptr) :: setup, contact

    call check(carom_setup_new(3_c_size_t, points, int(nodes, c_size_t), setup))
    call check(carom_setup_surface(setup, "block"//c_null_char, sides, 6_c_size_t, 4_c_size_t, 0_c_int))
    call check(carom_setup_plane(setup, "incline"//c_null_char, [0.0_dp, 0.0_dp, 0.0_dp], normal))
    call check(carom_setup_number(setup, "friction"//c_null_char, mu))
    call check(carom_setup_number(setup, "theta"//c_null_char, 1.0_dp))
    call check(carom_setup_build(setup, contact))
    call carom_setup_free(setup)
  end function

  ! Slides for some steps down a slope [rad]; whether it went as it has to.
  logical function slid(slope, steps)
    real(dp), intent(in) :: slope
    integer, intent(in) :: steps
    real(dp) :: down(3), normal(3), points(3, nodes), u(unknowns), v(unknowns), d(unknowns), weight(unknowns)
    real(dp) :: free(unknowns), force(unknowns), brake, expected, found, initial, total, kinetic, potential, path
    type(c_ptr) :: contact
    type(carom_step) :: done
    type(carom_ledger) :: ledger
    integer(c_size_t), parameter :: count = nodes, all = unknowns
    integer(c_int) :: failed, missed
    integer :: n, step

    down = [cos(slope), 0.0_dp, -sin(slope)]
    normal = [sin(slope), 0.0_dp, cos(slope)]
    do n = 0, nodes - 1
      points(:, n + 1) = ibits(n, 0, 1) * down + ibits(n, 1, 1) * [0, 1, 0] + ibits(n, 2, 1) * normal
    end do
    call assemble(points)
    call factorise()
    contact = touching(points, normal)
    u = 0
    v = reshape(spread(speed * down, 2, nodes), [unknowns])
    weight = 0
    weight(3::3) = mass * gravity
    initial = nodes * mass * speed**2 / 2
    total = initial
    path = 0

    do step = 1, steps
      call check(carom_contact_search(contact, moved(points, u), v, count, time_step, 0.0_dp))
      force = mass * v / time_step - matmul(stiffness, u) - weight
      d = time_step * v
      failed = solve(c_null_ptr, all, 1_c_size_t, force, free)
      missed = 1
      do while (missed /= 0)
        ! All is linear, gaps too: once is enough.
        call check(carom_contact_evaluate(contact, moved(points, u + d), count))
        call check(carom_contact_solve(contact, free, all, c_funloc(solve), c_null_ptr, d))
        call check(carom_contact_missed(contact, moved(points, u + d), count, missed))
      end do
      call check(carom_contact_accept(contact, moved(points, u + d), count, done))
      call check(carom_contact_ledger(contact, ledger))

      u = u + d
      v = d / time_step
      kinetic = mass * dot_product(v, v) / 2
      potential = dot_product(u, matmul(stiffness, u)) / 2 + dot_product(weight, u)
      path = dot_product(mean(u), down)
      total = kinetic + potential + ledger%work%friction + ledger%work%normal_contact
      if (mod(step, 50) == 0) write (*, '(6es25.17)') ledger%time, kinetic, potential, ledger%work%friction, &
        ledger%work%normal_contact, path
    end do
    call carom_contact_free(contact)

    brake = gravity * (mu * cos(slope) - sin(slope))
    if (brake > 0) then
      expected = speed**2 / (2 * brake)
      found = path
    else
      ! Momentum along the incline; nodes that also go sideways are braked less.
      expected = speed - brake * steps * time_step
      found = dot_product(mean(v), down) + mu * dot_product(mean(v), normal)
    end if
    slid = abs(found - expected) < merge(1e-2_dp, 1e-5_dp, brake > 0) * expected .and. total < initial &
      .and. total > 0.99_dp * initial
  end function

  ! Where the nodes are.
  function moved(points, by) result(at)
    real(dp), intent(in) :: points(3, nodes), by(unknowns)
    real(dp) :: at(3, nodes)

    at = points + reshape(by, [3, nodes])
  end function

  function mean(of)
    real(dp), intent(in) :: of(unknowns)
    real(dp) :: mean(3)

    mean = sum(reshape(of, [3, nodes]), 2) / nodes
  end function
end program
