#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
#
# Installs the Debian packages of one or more sections of packages.txt: scripts/install_packages.sh build [test]
# Works as root or with sudo; does nothing where all of them are there.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
[ $# -ge 1 ] || { echo "usage: $0 SECTION..." >&2; exit 2; }

packages=()
for section in "$@"; do
  mapfile -t -O "${#packages[@]}" packages < <(
    awk -v want="[$section]" '/^\[/ {inside = ($0 == want); next} inside && NF && !/^#/ {print $1}' "$root/packages.txt")
done

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f '${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
done
as_root=()
if [ "$(id -u)" -ne 0 ]; then as_root=(sudo); fi
if [ ${#missing[@]} -gt 0 ]; then
  echo "Installing ${#missing[@]} Debian packages: ${missing[*]}"
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
fi

# libtorch takes whatever BLAS the alternatives name; the reference BLAS trains ten times slower
arch=$(dpkg --print-architecture | sed 's/amd64/x86_64/; s/arm64/aarch64/')-linux-gnu
for library in blas lapack; do
  wanted=/usr/lib/$arch/openblas-openmp/lib$library.so.3
  current=$(readlink -f "/etc/alternatives/lib$library.so.3-$arch" || true)
  if [ -e "$wanted" ] && [ "$current" != "$(readlink -f "$wanted")" ]; then
    "${as_root[@]}" update-alternatives --set "lib$library.so.3-$arch" "$wanted" >/dev/null
  fi
done
