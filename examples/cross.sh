# Sourced by the examples that run on other machines than the one they are built on.
#
#   cross TARGET LIBRARIES
#
# finds the standard library of a target and leaves in `cross` what cargo has to be told.
# Where rustup has installed it, that is all; otherwise LIBRARIES of it are built from the
# sources that Debian packages, with the compiler of the same version.

# What was asked for can't be had on this machine.
missing() {
    echo "$*" >&2
    exit 77
}

# Installs Debian packages that aren't there.
packages() {
    local package all=1
    for package in "$@"; do
        [ "$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] \
            || all=0
    done
    [ $all = 1 ] && return
    local how="apt-get install --no-install-recommends $*"
    command -v apt-get >/dev/null || missing "this machine has no Debian packages: $*"
    [ "$(id -u)" = 0 ] || missing "packages are missing; install them with: sudo $how"
    echo "$how"
    { apt-get -qq update && $how -qq --yes; } >/dev/null || missing "$how: failed"
}

cross() {
    local target=$1 libraries=$2 sysroot
    sysroot=$(rustc --print sysroot)
    cross=(--target "$target")
    [ -d "$sysroot/lib/rustlib/$target/lib" ] && return
    echo "the target $target isn't installed (\`rustup target add $target\` does that);" \
        "building $libraries from Debian's sources"
    packages rustc-web rust-web-src
    local lld
    lld=$(find "$sysroot/lib/rustlib" -name rust-lld -type f | head -n 1)
    [ -n "$lld" ] || missing "$sysroot has no rust-lld; install Rust with rustup"
    # The sources build with the compiler they belong to, and only where it may use what
    # isn't stable yet.
    export RUSTC=/usr/bin/rustc RUSTC_BOOTSTRAP=1
    export "CARGO_TARGET_$(tr 'a-z.-' 'A-Z__' <<<"$target")_LINKER=$lld"
    cross+=("-Zbuild-std=$libraries")
}
