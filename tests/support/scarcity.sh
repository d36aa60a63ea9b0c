# SPDX-License-Identifier: MIT
#
# scarcity.sh - what the scripts share that let the memory of a program run out. They set `preload`, the library of
# scarcity_preload.c, and have a function miss().

# once WORD OUTPUTS COMMAND...: runs a command, OUTPUTS being files with the word "old" before; its allocation `number`
# fails, or (WORD not empty) all from it on. 0: none. True if the command ends with 0; `status` is what it ends with.
once() {
    word=$1 outputs=$2
    shift 2
    for output in $outputs; do echo old >"$output"; done
    timeout 20 env LD_PRELOAD="$preload" NARC_ALLOCATIONS=allocations.txt NARC_DENIED="$number" \
        ${word:+NARC_DENIED_ON=1} "$@" >printed.txt 2>err.txt
    status=$?
    [ $status -eq 0 ]
}

growing= # outputs that the command writes bit by bit: a failed one leaves a part
# run_out NAME STATUS OUTPUTS COMMAND...: whichever allocation fails, one or all from it on, the command ends as it
# otherwise does, with the same outputs (without any: what it prints), or with STATUS, word of memory, and outputs as they
# were. Nothing else stays. Of the first allocations each one fails, of later ones, which are much the same, some.
run_out() {
    name=$1 expected=$2 files=$3 number=0 failed=0
    shift 3
    rm -f allocations.txt
    once "" "$files" "$@" || miss "$name"
    [ -f allocations.txt ] || exit 77 # another C library
    count=$(cat allocations.txt)
    mv printed.txt usual.txt
    for output in $files $growing; do mv "$output" "usual-$output"; done
    number=1
    while [ "$number" -le "$count" ]; do
        for on in "" on; do
            if once "$on" "$files" "$@"; then
                [ -n "$files" ] || cmp -s printed.txt usual.txt || miss "$name, allocation $number $on: prints something else"
                for output in $files $growing; do
                    cmp -s "$output" "usual-$output" || miss "$name, allocation $number $on: $output is not what it was"
                done
            else
                failed=$((failed + 1))
                [ $status -eq "$expected" ] || miss "$name, allocation $number $on: status $status"
                grep -q "emory" err.txt || miss "$name, allocation $number $on: no word of memory"
                [ ! -s printed.txt ] || miss "$name, allocation $number $on: prints something"
                for output in $files; do
                    [ "$(cat "$output")" = old ] || miss "$name, allocation $number $on: $output has changed"
                done
            fi
            for left in .narc-*; do
                [ ! -e "$left" ] || { miss "$name, allocation $number $on: a temporary file stays" && rm -f "$left"; }
            done
        done
        number=$((number + 1 + (number > 24 ? number / 5 : 0)))
    done
    [ $failed -gt 0 ] || miss "$name: no allocation that matters"
    echo "$name: $count allocations, $failed runs ended early"
}
