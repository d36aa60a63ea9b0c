#!/bin/sh
# SPDX-License-Identifier: MIT
# The libraries of the command for Windows, static, from Debian's source packages: build/packages/mingw64. Their sources
# come by package lists of their own; the system does not change.
set -eu
cd "$(dirname "$0")/.."
root=$PWD/build/packages host=x86_64-w64-mingw32
prefix=$root/mingw64
[ ! -e "$prefix/complete" ] || exit 0
rm -rf "$prefix" "$root/mingw64-source"
mkdir -p "$prefix/licences" "$root/mingw64-source/lists/partial" "$root/mingw64-source/parts"
cd "$root/mingw64-source"

# The system's own package sources, asked for source packages.
for list in /etc/apt/sources.list /etc/apt/sources.list.d/*.list; do
    [ ! -f "$list" ] || sed -n 's/^deb /deb-src /p' "$list" >>sources.list
done
for list in /etc/apt/sources.list.d/*.sources; do
    [ ! -f "$list" ] || sed 's/^Types:.*/Types: deb-src/' "$list" >"parts/$(basename "$list")"
done
apt="apt-get -q -o APT::Sandbox::User=root -o Dir::State::lists=$PWD/lists -o Dir::Cache=$PWD
    -o Dir::Etc::SourceList=$PWD/sources.list -o Dir::Etc::SourceParts=$PWD/parts"
# shellcheck disable=SC2086 # a list of words
fetch() { $apt source --download-only --only-source "$@"; }
$apt update || true # the downloads decide

# unpack PACKAGE: with Debian's changes, or where not all files of those can be had, as its authors gave it out.
unpack() {
    if fetch "$1"; then
        dpkg-source --no-check -x "$1"_*.dsc "$1"
    else
        fetch --tar-only "$1"
        mkdir "$1"
        tar -xf "$1"_*.orig.tar.* -C "$1" --strip-components=1
    fi
    for file in "$1"/LICENSE* "$1"/COPYING*; do
        [ ! -f "$file" ] || cp "$file" "$prefix/licences/$1-$(basename "$file")"
    done
}

# by_cmake PACKAGE OPTION ..., by_configure PACKAGE FOLDER SOURCES OPTION ...: SOURCES is the folder of the library itself.
by_cmake() {
    package=$1
    shift
    unpack "$package"
    cmake -S "$package" -B "$package/build" -DCMAKE_TOOLCHAIN_FILE="$root/../../cmake/mingw64.cmake" \
        -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX="$prefix" -DBUILD_SHARED_LIBS=OFF "$@"
    cmake --build "$package/build" --target install
}
by_configure() {
    package=$1 folder=$1/$2 sources=$3
    shift 3
    unpack "$package"
    (
        cd "$folder"
        flags="-O2 -I$prefix/include -Wp,-U_FORTIFY_SOURCE" # which needs another library of GCC's
        ./configure --host=$host --prefix="$prefix" --disable-shared --enable-static "$@" \
            CC=$host-gcc-posix CXX=$host-g++-posix CFLAGS="$flags" CXXFLAGS="$flags" \
            LDFLAGS="-L$prefix/lib" PKG_CONFIG=pkg-config
        # Debian changes what configure is made of, for other systems.
        make -j "$(nproc)" ACLOCAL=: AUTOCONF=: AUTOHEADER=: AUTOMAKE=: SUBDIRS="$sources" install
    )
}
export PKG_CONFIG_LIBDIR="$prefix/lib/pkgconfig"

# zlib is a package; where its DLL is, linkers take that.
mkdir -p "$prefix/include" "$prefix/lib/pkgconfig"
cp /usr/$host/include/zlib.h /usr/$host/include/zconf.h "$prefix/include"
cp /usr/$host/lib/libz.a "$prefix/lib"
cp /usr/share/doc/libz-mingw-w64-dev/copyright "$prefix/licences/zlib"
sed "s|/usr/$host|$prefix|" /usr/$host/lib/pkgconfig/zlib.pc >"$prefix/lib/pkgconfig/zlib.pc"
by_cmake cjson -DCMAKE_C_FLAGS=-DCJSON_HIDE_SYMBOLS -DENABLE_CUSTOM_COMPILER_FLAGS=OFF -DENABLE_CJSON_TEST=OFF -DBUILD_SHARED_AND_STATIC_LIBS=OFF
by_cmake libpng1.6 -DPNG_SHARED=OFF -DPNG_TESTS=OFF
by_cmake freetype -DFT_DISABLE_HARFBUZZ=ON -DFT_DISABLE_BROTLI=ON -DFT_DISABLE_BZIP2=ON -DFT_DISABLE_PNG=ON
by_configure pixman . pixman --disable-gtk --disable-libpng
by_configure cairo . src --disable-ft --disable-fc --disable-ps --disable-pdf --disable-gobject --disable-trace --disable-interpreter
touch "$prefix/complete"
