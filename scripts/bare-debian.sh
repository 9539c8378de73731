# SPDX-License-Identifier: MIT
# A bare Debian 12 in a folder, to try in what people try first: shared by fresh-root.sh and package.sh. To be sourced
# after lib.sh. Needs root and debootstrap; mirror and proxy are those of this machine's apt.

# can_make_bare: whether there is what it needs; says what is missing.
can_make_bare() {
  ((EUID == 0)) || { say "making a root file system needs root"; return 1; }
  command -v debootstrap >/dev/null || { say "needs debootstrap: apt-get install debootstrap"; return 1; }
}

# make_bare FOLDER: a fresh FOLDER/root, copied from FOLDER/bare, which is made first where it is not there.
make_bare() {
  local folder=$1 archives mirror proxy
  mkdir -p "$folder"
  # "<address> <release>" of each Debian 12 archive that this machine's apt knows.
  archives=$(apt-get indextargets --format '$(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' 2>/dev/null |
    sed -n 's/^\([^ ]* bookworm[^ ]*\) main$/\1/p' | sort -u)
  mirror=$(sed -n 's/ bookworm$//p' <<<"$archives" | head -n 1)
  : "${mirror:=http://deb.debian.org/debian}"
  [[ -n $archives ]] || archives="$mirror bookworm"

  if [[ ! -e $folder/bare.done ]]; then
    say "making a bare Debian 12"
    proxy=$(apt-config dump --format '%v' Acquire::http::Proxy || true)
    rm -rf --one-file-system "$folder/bare"
    env ${proxy:+http_proxy="$proxy"} debootstrap --variant=minbase bookworm "$folder/bare" "$mirror" \
      >"$folder/debootstrap.log" 2>&1 ||
      { cat "$folder/debootstrap.log" >&2; return 1; }
    sed 's/^/deb /; s/$/ main/' <<<"$archives" >"$folder/bare/etc/apt/sources.list"
    apt-config dump | grep -E '^Acquire::(https?::Proxy|Check-)' >"$folder/bare/etc/apt/apt.conf.d/90host" || true
    cp -L /etc/resolv.conf "$folder/bare/etc/resolv.conf"
    touch "$folder/bare.done"
  fi
  rm -rf --one-file-system "$folder/root"
  cp -a --reflink=auto "$folder/bare" "$folder/root"
  chroot "$folder/root" useradd -m -s /bin/bash visitor
}

# inside_bare FOLDER USER COMMAND: runs it in FOLDER/root, with an environment as bare as the system.
inside_bare() {
  unshare --mount --pid --fork -- bash -c '
    mount -t proc proc "$1/proc" && mount -t devpts -o newinstance,ptmxmode=666 devpts "$1/dev/pts" && shift &&
    exec env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 HOME=/tmp "$@"' - \
    "$1/root" chroot --userspec="$2" "$1/root" bash -c "$3" </dev/null
}
