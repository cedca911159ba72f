#!/bin/sh
# How other projects take the library: mpm.c, the headers copied, make install, pkg-config, CMake, a release. Every
# way builds and runs a small program in a project of its own. Given: the compiler's name.
set -u
cc=${1:-cc}
root=$(pwd)
dir=$root/build/tests/vendor
rm -rf "$dir"
mkdir -p "$dir"
. tests/check.sh
strict="-pedantic -Wall -Wextra -Wconversion -Wshadow -Werror"
has() { command -v "$1" >/dev/null; }
skip() { echo "skip - $1"; }
cxx= # the C++ compilers there are
for c in g++ clang++; do has $c && cxx="$cxx $c"; done
[ -n "$cxx" ] || skip "neither g++ nor clang++ is installed: C++ projects were not tried"
unset MAKEFLAGS MFLAGS MAKELEVEL DESTDIR PREFIX CFLAGS CXXFLAGS LDFLAGS # no wishes of the make that runs this
version=$(sed -n 's/^#define MPM_VERSION "\(.*\)"/\1/p' mpm.h)

# The small programs: one.c holds the implementation, many.c leaves it to mpm.c.
cat >"$dir/many.c" <<END
#include "mpm.h"
#include "mpm_ptw.h"
#include <stdio.h>
int main(void)
{
    mpm_units si = mpm_units_si();
    mpm_material copper;
    if (mpm_material_preset(&copper, "cu", &si, NULL) != MPM_OK) return 1;
    printf("mpm %s\\n", mpm_version());
    return copper.density > 8000 && copper.density < 10000 ? 0 : 1;
}
END
{ echo '#define MPM_IMPLEMENTATION' && cat "$dir/many.c"; } >"$dir/one.c"
says() { [ "$("$@")" = "mpm $version" ]; } # the program runs and names this version
check "mpm.h names a version" sh -c "echo '$version' | grep -qE '^[0-9]+\.[0-9]+\.[0-9]+\$'"

# ---- mpm.c: every header, clean by every compiler ----------------------------------------------
for h in mpm*.h; do
    check "mpm.c includes $h" grep -qx "#include \"$h\"" mpm.c
done
for real in double float; do
    flag=
    [ $real = float ] && flag=-DMPM_FLOAT
    for c in gcc clang; do
        has $c || continue
        check "mpm.c $real $c c99" $c -std=c99 $strict $flag -I. -O1 -c mpm.c -o "$dir/mpm_$c$flag.o"
    done
    for c in $cxx; do
        check "mpm.c $real $c c++11" $c -x c++ -std=c++11 -Wall -Wextra -Werror $flag -I. -fsyntax-only mpm.c
    done
done

# ---- headers copied ----------------------------------------------------------------------------
mkdir "$dir/copy"
cp mpm*.h mpm.c "$dir/copy"
cd "$dir/copy" || exit 1
check "copied: one file" "$cc" -std=c99 -I. ../one.c -o one -lm
check "... runs" says ./one
check "copied: mpm.c beside it" "$cc" -std=c99 -I. ../many.c mpm.c -o many -lm
check "... runs" says ./many
cd "$root" || exit 1

# ---- make install, pkg-config ------------------------------------------------------------------
check "make install" make -s install PREFIX="$dir/made" CC="$cc"
check "make install for a packager" make -s install PREFIX=/opt/mpm DESTDIR="$dir/staged" CC="$cc"
check "... names the place it will have" grep -qx 'prefix=/opt/mpm' "$dir/staged/opt/mpm/share/pkgconfig/mpm.pc"
if has pkg-config; then
    PKG_CONFIG_PATH=$dir/made/share/pkgconfig
    export PKG_CONFIG_PATH
    check "pkg-config knows the version" [ "$(pkg-config --modversion mpm)" = "$version" ]
    flags=$(pkg-config --cflags --libs mpm)
    check "pkg-config: one file" "$cc" -std=c99 "$dir/one.c" -o "$dir/one" $flags
    check "... runs" says "$dir/one"
    source=$(pkg-config --variable=source mpm)
    check "pkg-config: its mpm.c" "$cc" -std=c99 "$dir/many.c" "$source" -o "$dir/many" $flags
    check "... runs" says "$dir/many"
else
    skip "pkg-config is not installed: what mpm.pc says was not tried"
fi
cp -r "$dir/staged" "$dir/left"
check "make uninstall" make -s uninstall PREFIX=/opt/mpm DESTDIR="$dir/left" CC="$cc"
check "... leaves no file" [ -z "$(find "$dir/left" -type f)" ]

# ---- CMake -------------------------------------------------------------------------------------
project() { # folder, languages, where the library comes from, targets...: a project of one program per target
    folder=$dir/$1
    mkdir -p "$folder"
    printf 'cmake_minimum_required(VERSION 3.14)\nproject(user LANGUAGES %s)\n%s\n' "$2" "$3" >"$folder/CMakeLists.txt"
    shift 3
    for t in "$@"; do
        case $t in
        impl) source=many.c ;;
        cpp) source=one.cpp t=mpm ;;
        *) source=one.c ;;
        esac
        cp "$dir/${source%.*}.c" "$folder/$source"
        printf 'add_executable(%s %s)\ntarget_link_libraries(%s PRIVATE mpm::%s)\n' "with_$t" $source "with_$t" "$t"
    done >>"$folder/CMakeLists.txt"
}
configure() { # folder
    cmake -S "$dir/$1" -B "$dir/$1/build" -DCMAKE_C_COMPILER="$cc" -DCMAKE_CXX_COMPILER="${cxx##* }" \
        -DCMAKE_PREFIX_PATH="$dir/cmade"
}
build() { # folder, programs...
    folder=$1
    shift
    check "$folder: configures" configure "$folder"
    check "$folder: builds" cmake --build "$dir/$folder/build"
    for p in "$@"; do check "$folder: $p runs" says "$dir/$folder/build/$p"; done
}
if has cmake; then
    project add_subdirectory C "add_subdirectory($root mpm)" mpm impl
    build add_subdirectory with_mpm with_impl
    project add_headers C "add_subdirectory($root mpm)" mpm
    build add_headers with_mpm
    built=$(find "$dir/add_headers" -name '*mpm.a' -o -name 'mpm.*o*')
    check "... mpm.c is compiled only if asked for" [ -z "$built" ]
    check "... installs the project" cmake --install "$dir/add_headers/build" --prefix "$dir/theirs"
    check "... and nothing of ours" [ ! -e "$dir/theirs/include" ]

    check "cmake configures" cmake -S . -B "$dir/cbuild" -DCMAKE_C_COMPILER="$cc"
    check "cmake installs" cmake --install "$dir/cbuild" --prefix "$dir/cmade"
    check "cmake installs for a packager" env DESTDIR="$dir/cstaged" cmake --install "$dir/cbuild" --prefix /opt/mpm
    rm -rf "$dir/cstaged/opt/mpm/share/cmake"
    check "... the same files as make" diff -r "$dir/staged" "$dir/cstaged"
    project find_package C 'find_package(mpm '"${version%.*}"' REQUIRED)' mpm impl
    build find_package with_mpm with_impl
    project find_twice C 'find_package(mpm REQUIRED)
find_package(mpm REQUIRED)' impl
    build find_twice with_impl
    if [ -n "$cxx" ]; then
        project find_cpp CXX 'find_package(mpm REQUIRED)' cpp
        build find_cpp with_mpm
    fi
    project find_newer C 'find_package(mpm 99 REQUIRED)' mpm
    check "find_package refuses a version that is not there" sh -c "! cmake -S '$dir/find_newer' \\
        -B '$dir/find_newer/build' -DCMAKE_C_COMPILER='$cc' -DCMAKE_PREFIX_PATH='$dir/cmade' 2>'$dir/newer' || exit 1
        grep -q 'version: $version' '$dir/newer'"
else
    skip "cmake is not installed: its packages were not tried"
fi

# ---- a release ---------------------------------------------------------------------------------
check "make dist" make -s dist CC="$cc"
mkdir "$dir/release"
check "the archive unpacks" tar xzf "build/mpm-$version.tar.gz" -C "$dir/release"
check "... and packs itself again" make -s -C "$dir/release/mpm-$version" dist CC="$cc"
check "... with the same files" sh -c "tar tzf 'build/mpm-$version.tar.gz' >'$dir/list' &&
    tar tzf '$dir/release/mpm-$version/build/mpm-$version.tar.gz' | sort >'$dir/again' &&
    sort '$dir/list' | diff - '$dir/again'"
check "... and the same mpm_all.h" cmp build/mpm_all.h "$dir/release/mpm-$version/build/mpm_all.h"
check "... and builds its programs" make -s -C "$dir/release/mpm-$version" build/material CC="$cc" CFLAGS=-O0
check "no header is missing in mpm_all.h" sh -c 'for h in mpm*.h; do grep -q "^/\* $h - " build/mpm_all.h || exit 1; done'

# mpm_all.h stands alone: in a folder without the headers, with the README's program.
mkdir "$dir/all"
cp build/mpm_all.h "$dir/all"
cd "$dir/all" || exit 1
sed -n '/^```c$/,/^```$/p' "$root/README.md" | sed '/^```/d; s/"mpm\.h"/"mpm_all.h"/; /"mpm_.*\.h"/{/mpm_all/!d;}' >readme.c
printf '#include "mpm_all.h"\n#include "mpm_all.h"\nint main(void) { return mpm_version()[0] == 0; }\n' >twice.c
printf '#define MPM_STATIC\n' | cat - twice.c >static.c
for real in double float; do
    flag=
    [ $real = float ] && flag=-DMPM_FLOAT
    for c in gcc clang; do
        has $c || continue
        check "mpm_all.h $real $c c99" $c -std=c99 $strict $flag -DMPM_IMPLEMENTATION twice.c -o twice -lm
        check "... static" $c -std=c99 $strict $flag static.c -o twice -lm
    done
    for c in $cxx; do
        check "mpm_all.h $real $c c++11" $c -x c++ -std=c++11 -Wall -Wextra -Werror $flag -DMPM_IMPLEMENTATION \
            -fsyntax-only twice.c
    done
done
check "the README's program with mpm_all.h" "$cc" -std=c99 $strict -O2 readme.c -o readme -lm
check "... runs" ./readme
cd "$root" || exit 1

check_end
