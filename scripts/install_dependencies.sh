#!/usr/bin/env bash
# Installs the Debian packages that legible is built, tested and (with --checks) linted with: says which, asks for
# nothing but sudo's password, and is silent where all are there.
set -euo pipefail

# Each package, and what needs it.
build_packages() {
  cat <<'LIST'
build-essential      C++20 compiler (GCC 12) and make
cmake                configures the build
ninja-build          runs the build
ccache               compiles nothing twice
mold                 links quickly
libeigen3-dev        vectors and matrices
libceres-dev         least squares
libflint-arb-dev     ball arithmetic: what proofs of roots compute with
libflint-dev         what Arb is built on; tests: exact counts of real roots
libgoogle-glog-dev   what Ceres logs through
libopencv-dev        reads images; first pose from tags; finds chessboards and wide-bordered tags
libapriltag-dev      finds AprilTags
libembree-dev        traces the rays of the simulated camera
libyaml-cpp-dev      reads YAML
libpugixml-dev       reads cameras in ViSP's and OpenCV's XML
nlohmann-json3-dev   writes JSON
libcli11-dev         command line
libfmt-dev           formatted text
libtbb-dev           works on several images at a time
libqhull-dev         convex hulls of errors
libboost-dev         Sobol points, Gauss rules, Owen's T for blurred corners
zlib1g-dev           whether a PNG is whole
libssl-dev           SHA-256 of a session, base64 of pictures
libgtest-dev         tests
libgmock-dev         tests
libbenchmark-dev     benchmarks
libvisp-core-dev     tests: ViSP reads the cameras written for it
libvisp-visual-features-dev  leg edges as features of ViSP
libvisp-me-dev       benchmarks: ViSP's moving edges, to compare with
libvisp-vs-dev       tests, benchmarks: ViSP's control law, to compare with
chromium             tests: opens the report's pages
LIST
}

# Debian's npm excludes a nodejs from elsewhere: left alone where a node of use is there already.
node_packages() {
  cat <<'LIST'
nodejs               runs the bundler of the report's scripts
npm                  fetches that bundler and the plot library
ca-certificates      npm's connections
LIST
}

check_packages() {
  cat <<'LIST'
clang-format         layout of the sources
clang-tidy           static analysis
python3-mrcal        tests: mrcal reads the cameras written for it
python3-yaml         tests: reads the cameras written for Kalibr as Kalibr does
linuxcnc-uspace      tests: halrun takes the lines written for genhexkins
git                  what has changed since a commit
LIST
}

has_node() {
  command -v npm >/dev/null && command -v node >/dev/null &&
    [[ $(node --print 'parseInt(process.versions.node)') -ge 18 ]]
}

is_installed() {
  [[ $(dpkg-query --show --showformat='${db:Status-Status}' "$1" 2>/dev/null) == installed ]]
}

as_root() {
  if [[ $EUID -eq 0 ]]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    echo "There is no sudo here: run as root: $*" >&2
    return 1
  fi
}

install_packages() {
  as_root apt-get update --quiet=2 || echo "Some package lists could not be updated; going on with what there is." >&2
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install --yes --quiet=2 --no-install-recommends "$@"
}

case "$*" in
  "" | --checks) ;;
  *)
    echo "usage: $0 [--checks]" >&2
    exit 2
    ;;
esac

wanted=$(
  build_packages
  has_node || node_packages
  [[ ${1-} != --checks ]] || check_packages
)

if ! command -v apt-get >/dev/null; then
  printf 'This is no Debian: see to it yourself that there is what these packages hold.\n%s\n' "$wanted" >&2
  exit 0
fi

missing=()
table=""
while read -r package purpose; do
  is_installed "$package" && continue
  missing+=("$package")
  table+=$(printf '  %-20s %s' "$package" "$purpose")$'\n'
done <<<"$wanted"

if [[ ${#missing[@]} -gt 0 ]]; then
  printf 'Installing Debian packages, and what they depend on:\n%s' "$table"
  install_packages "${missing[@]}"
fi
