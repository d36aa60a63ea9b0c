#!/bin/sh
# SPDX-License-Identifier: MIT
#
# files.sh NARC [FONT] - outputs that appear whole or not at all.
. "$(dirname "$0")/common.sh"

works "collide" collide $known --out known.csv
works "a scene" scene --shapes shapes.json --bodies 3000 --density 0.6 --seed 7 --out scene.csv
# ------------------------------------------------------------------------------------------- outputs that cannot be
fails "output in no folder" "narc: absent/new.csv: " collide $known --out absent/new.csv
fails "output under a file" "narc: shapes.json/new.csv: " collide $known \
    --out shapes.json/new.csv
mkdir full.csv
fails "output is a folder" "narc: full.csv: " collide $known --out full.csv
fails "picture in no folder, contacts given up" "narc: absent/few.png: " collide $known \
    --out new.csv --picture absent/few.png
fails "one file for both outputs" "narc: .*same" collide $known --out few.svg --picture few.svg
mkdir inside
fails "one new file for both outputs" "narc: .*same" collide $known --out new.svg --picture ./new.svg
fails "one new file, another way to its folder" "narc: .*same" collide $known --out new.svg --picture inside/../new.svg
works "the same name in two folders" collide $known --out few.svg --picture inside/few.svg
check "are two files" sh -c 'cmp few.svg known.csv && ! cmp -s few.svg inside/few.svg'

# An input stays what it is, whatever name an output gives it.
printf 'a,b\n0,1\n' >pair.csv
cp shapes.json kept.json && cp bodies.csv kept.txt && ln pair.csv hard.csv && ln -s bodies.csv soft.csv
for output in shapes.json ./bodies.csv soft.csv; do
    fails "output $output is an input" "narc: $output: .*input" collide $known --pairs pair.csv --out $output
done
fails "a scene's output is its input" "narc: shapes.json: .*input" scene $five --density 1 --seed 1 --out shapes.json
works "an output may have another name of an input" collide $known --pairs pair.csv --out hard.csv
check "then they are two files" sh -c '[ "$(cat pair.csv)" = "$(printf "a,b\n0,1")" ] && ! cmp -s pair.csv hard.csv'
check "inputs are unchanged" sh -c 'cmp shapes.json kept.json && cmp bodies.csv kept.txt && [ -L soft.csv ]'

mkdir "ü👻"
works "names of any letters" collide $known --out "ü👻/人.csv" --picture "ü👻/人.png"
check "are the file's own" sh -c 'cmp "ü👻/人.csv" known.csv && [ "$(find ü👻 -type f | wc -l)" -eq 2 ]'
fails "a name of any letters, no file" "narc: ü👻/no.csv: " collide --shapes shapes.json --bodies "ü👻/no.csv"

# The longest name that a file system allows has no room for a suffix.
long=$(printf '%0250d' 0)
works "a long name" collide $known --out $long
check "a long name: the contacts" cmp $long known.csv
rm $long

# closed STREAM NAME ARGUMENTS...: with that standard stream closed narc fails and leaves no file behind.
closed() {
    stream=$1 name=$2
    shift 2
    case $stream in
    1) "$narc" "$@" >&- 2>err.txt ;;
    2) "$narc" "$@" 2>&- >out.txt ;;
    esac
    status=$?
    check "closed stream $stream: $name" test $status -eq 2 -a -z "$(find . -name 'new*' -o -name '.narc-*')"
    rm -f new* .narc-*
}
closed 1 "contacts and a picture" collide $known --out - --picture new.png
check "closed stream 1 is told" grep -q "^narc: standard output: " err.txt
closed 1 "a report that cannot be printed" collide $known --out new.csv --picture new.png
closed 1 "a scene" scene $five --density 1 --seed 1
closed 1 "a scene's report" scene $five --density 1 --seed 1 --out new.csv
closed 1 "help" --help
closed 2 "a report beside contacts" collide $known --out - --picture new.png
"$narc" collide $known --out few.txt --picture few.png <&- >out.txt 2>err.txt
check "closed stream 0 is not needed" sh -c "[ $? -eq 0 ] && cmp few.txt known.csv"
check "and no picture" begins_with few.png XPNG
if [ "$(id -u)" -ne 0 ]; then
    mkdir locked && chmod 555 locked
    fails "unwritable folder" "narc: locked/new.csv: " collide $known --out locked/new.csv
fi
# What is read-only stays, also for root.
echo old >read-only.csv && chmod 444 read-only.csv
fails "a read-only file" "narc: read-only.csv: Permission denied" collide $known --out read-only.csv
fails "a read-only picture" "narc: read-only.png: Permission denied" collide $known --out new.csv \
    --picture "$(cp read-only.csv read-only.png && echo read-only.png)"
check "stays what it was" test "$(cat read-only.csv)" = old
if [ "$(id -u)" -eq 0 ] && [ "$system" != Windows ]; then
    echo old >owned.csv && chown 12345:54321 owned.csv && chmod 640 owned.csv
    works "a file of another owner" collide $known --out owned.csv
    check "keeps its owner, group and permissions" sh -c 'cmp owned.csv known.csv &&
        ls -ln owned.csv | grep -q "^-rw-r-----.* 12345  *54321 "'
fi

# What is too large to read is known at once where it is a file.
large="it has more than 1 GiB, the most that is read"
if truncate -s 5G large.csv; then
    fails "bodies too large to read" "narc: large.csv: $large" collide --shapes shapes.json --bodies large.csv
    fails "shapes too large to read" "narc: large.csv: $large" collide --shapes large.csv --bodies bodies.csv
    fails "points too large to read" "narc: standard input: $large" fit - --arcs 4 --out new.json <large.csv
    rm large.csv
fi
if awk '/^MemAvailable/ { enough = $2 > 4e6 } END { exit !enough }' /proc/meminfo 2>/dev/null && [ -c /dev/zero ]; then
    fails "a stream too large to read" "narc: /dev/zero: $large" fit /dev/zero --arcs 4 --out new.json
fi

if [ -c /dev/full ]; then
    fails "full disk" "narc: /dev/full: No space left on device" collide --shapes shapes.json --bodies scene.csv --out /dev/full \
        --picture new.png
    ln -s /dev/full full.png
    ln -s /dev/full full.svg
    for kind in png svg; do
        fails "full disk, picture, $kind" "narc: full.$kind: No space left on device" collide --shapes shapes.json \
            --bodies scene.csv --out new.csv --picture full.$kind
    done
    printf '0,0\n4,0\n4,3\n' >triangle.csv
    fails "full disk, picture of a fit" "narc: full.png: No space left on device" fit triangle.csv --arcs 3 \
        --out new.json --picture full.png
    fails "full disk, shapes" "narc: /dev/full: No space left on device" fit triangle.csv --arcs 3 --out /dev/full \
        --picture new.png
    "$narc" collide $known --out new.csv --picture new.png >/dev/full 2>err.txt
    check "full disk for the report" test $? -eq 2 -a -z "$(find . -name 'new*' -o -name '.narc-*')"
    printf 'x,y,motion_x,motion_y\n-5,0,10,0\n' >rays.csv
    fails "full disk, hits" "narc: /dev/full: No space left on device" cast $known --rays rays.csv --out /dev/full
    fails "full disk, scene" "narc: /dev/full: No space left on device" scene $five --density 1 --seed 1 --out /dev/full
    for command in --help --version info "collide --help" "collide $known --out -" "cast $known --rays rays.csv" \
        "scene $five --density 1 --seed 1" "fit triangle.csv --arcs 3"; do
        "$narc" $command >/dev/full 2>err.txt
        check "full standard output, $command" test $? -eq 2
    done
fi
# A command waits for a reader of its picture, while its contacts have a temporary file: signals leave no such file.
mkfifo stuck.png
signals="HUP INT QUIT ALRM TERM XCPU ABRT"
[ "$system" != Windows ] || signals= # wine ends by them
for signal in $signals; do
    env --default-signal=$signal "$narc" collide $known --out new.csv --picture stuck.png >out.txt 2>err.txt &
    waiting=$!
    tries=0
    while [ -z "$(find . -name '.narc-*')" ] && [ $tries -lt 500 ]; do
        sleep 0.05
        tries=$((tries + 1))
    done
    check "SIG$signal: there is a temporary file" test -n "$(find . -name '.narc-*')"
    kill -s $signal $waiting
    wait $waiting 2>wait.log
    check "SIG$signal ends the command" test $? -gt 128
    check "SIG$signal leaves no file" test -z "$(find . -name 'new*' -o -name '.narc-*')"
    rm -f new* .narc-*
done
# A file may not grow beyond a limit (in blocks of 512 bytes).
if [ "$system" != Windows ]; then
    (ulimit -f 1 && exec "$narc" scene --shapes shapes.json --bodies 3000 --density 1 --seed 1 --out new.csv) \
        >out.txt 2>err.txt
    check "a file too large is an error" test $? -eq 2
    check "which is told" grep -q "^narc: new.csv: File too large$" err.txt
    check "and leaves no file" test -z "$(find . -name 'new*' -o -name '.narc-*')"
fi

echo old >kept.csv
fails "a wrong input" "narc: absent.csv: " collide --shapes shapes.json --bodies absent.csv --out kept.csv
check "keeps the old output" test "$(cat kept.csv)" = old
ln -s kept.csv link.csv
works "output through a link" collide $known --out link.csv
check "replaces what the link names" sh -c '[ -L link.csv ] && cmp kept.csv known.csv'

finish
