#!/bin/sh
# Lets a robot do something: sh robot.sh SOCKET [start|follow|drive|room [NUMBER]|rate]
set -eu
socket=$1
job=${2:-start}

connect() {
    socat -t 2 - "UNIX-CONNECT:$socket" | tr '\037' '\n'
}

# Says messages, and shows what comes within two seconds, a message a line.
ask() {
    printf '%s\037' "$@" | connect
}

# The text behind a key of JSON on one line.
text_of() {
    sed -n "s/.*\"$1\":\"\([^\"]*\)\".*/\1/p" | head -n 1
}

# The places that come.
places() {
    sed -n 's/.*"e":"pose".*"x":\([^,]*\),"y":\([^,]*\),.*/\1 \2/p'
}

# Ends the script when a message was refused.
obeyed() {
    if echo "$1" | grep -q '"e":"failed"'; then
        echo "$1" | grep '"e":"failed"' >&2
        exit 1
    fi
}

works() {
    state=none
    tries=0
    while [ "$state" != starting ] && [ "$state" != cleaning ]; do
        tries=$((tries + 1))
        if [ "$tries" -gt 10 ]; then
            echo "the robot does not work: $state" >&2
            exit 1
        fi
        state=$(ask '{"c":"watch","topics":["status"]}' | grep '"e":"status"' | text_of state)
    done
    echo "state: $state"
}

stop() {
    obeyed "$(ask '{"c":"stop","id":2}')"
    echo stopped
}

# Twenty times a lease of 300 ms, and what comes meanwhile.
back_away() {
    {
        printf '{"c":"watch","topics":["pose"]}\037{"c":"drive","v":0,"w":0,"ttl":300,"id":1}\037'
        sleep 0.2
        count=0
        while [ "$count" -lt 20 ]; do
            printf '{"c":"drive","v":-0.1,"w":0,"ttl":300,"id":3}\037'
            sleep 0.1
            count=$((count + 1))
        done
        printf '{"c":"stop","id":2}\037'
        sleep 0.3
    } | connect
}

if [ "$job" != rate ]; then
    device=$(ask '{"c":"hello","name":"a shell script"}' | text_of device)
    echo "robot: ${device:-none}"
fi
case $job in
start) # Starts it, follows it until it works, and stops it.
    obeyed "$(ask '{"c":"start","id":1}')"
    works
    ask '{"c":"watch","topics":["pose"]}' | places | head -n 1 | sed 's/\(.*\) \(.*\)/place: \1 m, \2 m/'
    stop
    ;;
follow) # Says how old the newest telemetry is, five times.
    { printf '{"c":"watch","topics":["device"]}\037'; sleep 3; } | connect |
        sed -n 's/.*"e":"device".*"age_ms":\([0-9]*\).*/telemetry: \1 ms old/p' | head -n 5
    ;;
drive) # Drives two seconds backwards at 0.1 m/s, as from its dock; who lets go stops.
    updates=$(back_away)
    obeyed "$updates"
    echo stopped
    echo "$updates" | places |
        awk 'NR == 1 { x = $1; y = $2 } { d = sqrt(($1 - x) ^ 2 + ($2 - y) ^ 2) } END { printf "driven: %.2f m\n", d }'
    ;;
room) # Cleans the room of this number, or the first one that it knows.
    room=${3:-$(ask '{"c":"watch","topics":["home"]}' | sed -n 's/.*"rooms":\[{"id":\([0-9]*\).*/\1/p' | head -n 1)}
    obeyed "$(ask "{\"c\":\"clean\",\"parts\":[{\"room\":$room}],\"id\":1}")"
    works
    echo "room: $room"
    stop
    ;;
rate) # Says how many packets a second it understands, until the other end closes.
    begin=$(date +%s%N)
    count=$(socat -u "UNIX-CONNECT:$socket" - | tr '\037' '\n' | places | wc -l)
    echo "packets a second: $((count * 1000000000 / ($(date +%s%N) - begin)))"
    ;;
*)
    echo "no job has the name $job" >&2
    exit 2
    ;;
esac
