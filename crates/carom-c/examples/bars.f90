! Two elastic bars meet, exchange their velocities and part. The same as bars.c, in Fortran.

! A finite element code: bars of linear elements whose motion is along x, two rows of nodes each, and a tridiagonal matrix.
module bars_code
  use, intrinsic :: iso_c_binding
  implicit none
  integer, parameter :: dp = c_double, cells = 20, nodes = 4 * (cells + 1)
  real(dp), parameter :: length = 1, height = 0.1_dp, young = 1e4_dp, density = 1 ! [m], [Pa], [kg/m3]
  real(dp), parameter :: speed = 1, gap = 1e-3_dp, time_step = 2.5e-4_dp ! [m/s], [m], [s]
  real(dp), parameter :: spring = young * height / 2 / (length / cells)
  real(dp) :: mass(nodes)

contains

  ! The number, from 0 as carom counts, of node (bar, i, row) with i from left to right; its one unknown has the same.
  pure integer function node(bar, i, row)
    integer, intent(in) :: bar, i, row

    node = 2 * (bar * (cells + 1) + i) + row
  end function

  function internal_force(u) result(force)
    real(dp), intent(in) :: u(0:nodes - 1)
    real(dp) :: force(0:nodes - 1), pull
    integer :: bar, i, row, a, b

    force = 0
    do bar = 0, 1
      do i = 0, cells - 1
        do row = 0, 1
          a = node(bar, i, row)
          b = node(bar, i + 1, row)
          pull = spring * (u(b) - u(a))
          force(a) = force(a) - pull
          force(b) = force(b) + pull
        end do
      end do
    end do
  end function

  ! Solves with 2 M / dt^2 + K / 2, row of nodes by row of nodes.
  function solve(context, count, columns, b, x) bind(c)
    type(c_ptr), value :: context
    integer(c_size_t), value :: count, columns
    real(dp), intent(in) :: b(count, columns)
    real(dp), intent(inout) :: x(count, columns)
    integer(c_int) :: solve
    real(dp) :: pivot(0:cells), factor
    integer :: bar, i, row, column, n

    do column = 1, int(columns)
      do bar = 0, 1
        do row = 0, 1
          do i = 0, cells
            n = node(bar, i, row) + 1
            pivot(i) = 2 * mass(n) / time_step**2 + spring * merge(0.5_dp, 1.0_dp, i == 0 .or. i == cells)
            x(n, column) = b(n, column)
            if (i > 0) then
              factor = spring / 2 / pivot(i - 1)
              pivot(i) = pivot(i) - spring / 2 * factor
              x(n, column) = x(n, column) + factor * x(n - 2, column)
            end if
          end do
          do i = cells, 0, -1
            n = node(bar, i, row) + 1
            if (i < cells) x(n, column) = x(n, column) + spring / 2 * x(n + 2, column)
            x(n, column) = x(n, column) / pivot(i)
          end do
        end do
      end do
    end do
    solve = merge(1, 0, c_associated(context))
  end function
end module

program bars
  use bars_code
  use carom
  implicit none
  real(dp) :: points(2, nodes), velocity(2, nodes), u(nodes), v(nodes), d(nodes), before(nodes), free(nodes), force(nodes)
  real(dp) :: correction, initial, worst, kinetic, strain, mean
  type(c_ptr) :: contact
  type(carom_step) :: done
  type(carom_ledger) :: ledger
  integer(c_size_t), parameter :: count = nodes
  integer(c_int) :: failed, missed
  integer :: bar, i, row, n, step, iteration

  do bar = 0, 1
    do i = 0, cells
      do row = 0, 1
        n = node(bar, i, row) + 1
        points(:, n) = [bar * (length + gap) + i * (length / cells), row * height]
        v(n) = merge(-speed, speed, bar == 1)
        mass(n) = merge(0.5_dp, 1.0_dp, i == 0 .or. i == cells) * density * height / 2 * (length / cells)
      end do
    end do
  end do
  contact = outlines()
  initial = density * length * height * speed**2
  worst = 0
  u = 0
  velocity = 0

  do step = 1, 120
    velocity(1, :) = v
    call check(carom_contact_search(contact, moved(u), velocity, count, time_step, 0.0_dp))
    force = 2 * mass * v / time_step - internal_force(u)
    d = time_step * v
    failed = solve(c_null_ptr, count, 1_c_size_t, force, free)
    missed = 1
    do while (missed /= 0)
      do iteration = 1, 20
        before = d
        call check(carom_contact_evaluate(contact, moved(u + d), count))
        call check(carom_contact_solve(contact, free, count, c_funloc(solve), c_null_ptr, d))
        correction = maxval(abs(d - before))
        if (correction <= 1e-15_dp) exit
      end do
      call check(carom_contact_missed(contact, moved(u + d), count, missed))
    end do
    call check(carom_contact_accept(contact, moved(u + d), count, done))
    call check(carom_contact_ledger(contact, ledger))

    u = u + d
    v = 2 * d / time_step - v
    kinetic = sum(mass * v**2) / 2
    strain = dot_product(u, internal_force(u)) / 2
    worst = max(worst, abs(kinetic + strain + ledger%work%normal_contact - initial))
    if (mod(step, 10) == 0) write (*, '(4es25.17)') ledger%time, kinetic, strain, ledger%work%normal_contact
  end do
  call carom_contact_free(contact)

  mean = sum(mass(:nodes / 2) * v(:nodes / 2)) / (density * length * height)
  if (abs(sum(mass * v)) > 1e-14_dp .or. mean > -0.9_dp * speed .or. worst > 1e-12_dp * initial) error stop 1

contains

  subroutine check(status)
    integer(c_int), intent(in) :: status

    if (status == CAROM_STATUS_OK) return
    write (*, '(a)') carom_message()
    error stop 2
  end subroutine

  ! Where the nodes are.
  function moved(by) result(at)
    real(dp), intent(in) :: by(nodes)
    real(dp) :: at(2, nodes)

    at = points
    at(1, :) = at(1, :) + by
  end function

  ! Contact of two closed outlines; y is prescribed, as -1 says.
  function outlines() result(contact)
    integer(c_int32_t) :: facets(2, 2 * cells + 2), unknowns(2, nodes)
    type(c_ptr) :: setup, contact
    integer(c_size_t), parameter :: facet_count = 2 * cells + 2
    character(5), parameter :: names(0:1) = ["left ", "right"]

    unknowns(1, :) = [(n, n=0, nodes - 1)]
    unknowns(2, :) = -1
    call check(carom_setup_new(2_c_size_t, points, count, setup))
    do bar = 0, 1
      do i = 0, cells - 1
        do row = 0, 1
          facets(:, 2 * i + row + 1) = [node(bar, i, row), node(bar, i + 1, row)]
        end do
      end do
      facets(:, 2 * cells + 1) = [node(bar, 0, 0), node(bar, 0, 1)]
      facets(:, 2 * cells + 2) = [node(bar, cells, 0), node(bar, cells, 1)]
      call check(carom_setup_surface(setup, trim(names(bar))//c_null_char, facets, facet_count, 2_c_size_t, 0_c_int))
    end do
    call check(carom_setup_unknowns(setup, unknowns, count, count))
    call check(carom_setup_build(setup, contact))
    call carom_setup_free(setup)
  end function
end program
