#!/bin/sh
# Starts the robot, follows it until it works, and stops it: sh robot.sh SOCKET
set -eu
socket=$1

# Says messages, and shows what comes within two seconds, a message a line.
ask() {
    printf '%s\037' "$@" | socat -t 2 - "UNIX-CONNECT:$socket" | tr '\037' '\n'
}

# The text behind a key of JSON on one line.
text_of() {
    sed -n "s/.*\"$1\":\"\([^\"]*\)\".*/\1/p" | head -n 1
}

# Ends the script when a message was refused.
obeyed() {
    if echo "$1" | grep -q '"e":"failed"'; then
        echo "$1" | grep '"e":"failed"' >&2
        exit 1
    fi
}

device=$(ask '{"c":"hello","name":"a shell script"}' | text_of device)
echo "robot: ${device:-none}"
obeyed "$(ask '{"c":"start","id":1}')"
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
ask '{"c":"watch","topics":["pose"]}' | grep -m 1 '"e":"pose"' | sed 's/.*"x":\([^,]*\),"y":\([^,]*\),.*/place: \1 m, \2 m/'
obeyed "$(ask '{"c":"stop","id":2}')"
echo stopped
