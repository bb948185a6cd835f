#!/usr/bin/env bash
# Makes .venv-ranks, in which carom runs on several ranks: Debian's MPI, mpi4py and petsc4py, and NumPy 1.26, which these were built for.
# As root it installs them. Where that cannot be, it says so, and the tests of `--engine petsc` are skipped.
set -uo pipefail
cd "$(dirname "$0")/.."
venv=.venv-ranks

without() {
	echo "ranks: $1; the tests of --engine petsc are skipped" >&2
	exit 0
}

[ -x "$venv/bin/python" ] && "$venv/bin/python" -c "import mpi4py.MPI, petsc4py.PETSc" 2>/dev/null && exit 0
command -v apt-get >/dev/null || without "Debian's packages are needed"
packages="python3-petsc4py python3-mpi4py openmpi-bin"
# shellcheck disable=SC2086
if ! dpkg -s $packages >/dev/null 2>&1; then
	[ "$(id -u)" = 0 ] || without "as root: apt-get install $packages"
	install="apt-get install -qq -y --no-install-recommends $packages"
	export DEBIAN_FRONTEND=noninteractive
	$install >/dev/null 2>&1 || { apt-get update -qq && $install; } >/dev/null 2>&1 || without "$packages: not installed"
fi
petsc=$(ls -d /usr/lib/petscdir/petsc*/*-real/lib/python3/dist-packages 2>/dev/null | tail -1)
[ -n "$petsc" ] || without "no petsc4py under /usr/lib/petscdir"
# Of the same minor version as the modules.
python=python$(/usr/bin/python3 -c "import sys; print('%d.%d' % sys.version_info[:2])")
"$python" -m venv --clear "$venv" || without "$python makes no environments"
dependencies=$("$python" - <<'END'
import re, pathlib
text = pathlib.Path("pyproject.toml").read_text()
block = re.search(r"^dependencies = \[(.*?)^\]", text, re.S | re.M)[1]
print(" ".join(re.findall(r'"(.*?)"', block)))
END
)
# shellcheck disable=SC2086
"$venv/bin/pip" install --quiet --disable-pip-version-check "numpy<2" $dependencies || without "pip failed"
site=$("$venv/bin/python" -c "import sysconfig; print(sysconfig.get_paths()['purelib'])")
ln -sfn /usr/lib/python3/dist-packages/mpi4py "$site/mpi4py"
ln -sfn "$petsc/petsc4py" "$site/petsc4py"
"$venv/bin/python" -c "import mpi4py.MPI, petsc4py.PETSc" || without "they cannot be imported"
