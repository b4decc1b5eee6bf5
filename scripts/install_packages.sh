#!/usr/bin/env bash
# Installs the Debian 12 packages that are missing, and nothing else. Asks nothing; works as root and with sudo; takes a moment when all are there.
#
#   scripts/install_packages.sh            what building and running Karcher needs
#   scripts/install_packages.sh build test the same, and what `make test` needs
#
# Sets: build, test, fuzz, bench, check (format), viewer (the page and its browser test).
set -euo pipefail

# libopenblas-dev is named although nothing here includes it: PETSc alone brings the reference BLAS, which factorises about ten times slower.
build=(g++ cmake make ninja-build pkg-config libpetsc-real-dev libmetis-dev libopenmpi-dev openmpi-bin libopenblas-dev libfmt-dev zlib1g-dev nlohmann-json3-dev
       libtomlplusplus-dev libcli11-dev libpugixml-dev)
test=(libgtest-dev libadolc-dev libmuparser-dev python3 python3-meshio python3-numpy python3-vtk9)
fuzz=(libclang-rt-14-dev)
bench=(libbenchmark-dev libadolc-dev)
check=(clang-format python3 git)
viewer=(chromium)

wanted=()
for set in "${@:-build}"; do
  case "$set" in
    build) wanted+=("${build[@]}") ;;
    test) wanted+=("${test[@]}") ;;
    fuzz) wanted+=("${fuzz[@]}") ;;
    bench) wanted+=("${bench[@]}") ;;
    check) wanted+=("${check[@]}") ;;
    viewer)
      wanted+=("${viewer[@]}")
      # Asked for by command, since other distributors pack npm into nodejs.
      command -v node >/dev/null || wanted+=(nodejs)
      command -v npm >/dev/null || wanted+=(npm)
      ;;
    *) echo "$0: there is no package set \"$set\"; the sets are build, test, fuzz, bench, check, viewer." >&2; exit 2 ;;
  esac
done

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  echo "This is not a Debian system. Karcher goes on and hopes to find what these packages hold: ${wanted[*]}" >&2
  exit 0
fi

missing=()
installed=$(dpkg-query -W -f '${Package} ${db:Status-Status}\n' 2>/dev/null | awk '$2 == "installed" {print $1}')
for package in "${wanted[@]}"; do
  grep -qx "$package" <<<"$installed" || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "Missing packages: ${missing[*]}. Install them as root: apt-get install --no-install-recommends ${missing[*]}" >&2; exit 1; }
  as_root=(sudo)
fi
install() { "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "${missing[@]}" </dev/null; }

echo "Installing ${missing[*]}"
# The lists on the machine usually do; they are fetched anew only if they do not (a fresh container has none).
if ! ls /var/lib/apt/lists/*_Packages* >/dev/null 2>&1 || ! install; then
  "${as_root[@]}" apt-get update -q </dev/null
  install
fi
