#!/usr/bin/env raku
# Starts the robot, follows it until it works, and stops it: raku robot.raku SOCKET
#
# Rakudo has sockets of the network only, so socat stands between; its JSON parser is a module of its own, so the few keys that are needed
# are taken out with regexes.

my constant SEPARATOR = "\x1f";

class Robot {
    has $.process = Proc::Async.new(:w, 'socat', '-t', '30', '-', "UNIX-CONNECT:{@*ARGS[0]}");
    has $.updates = Channel.new;

    method connect() {
        my $rest = '';
        $!process.stdout.tap(-> $text {
            $rest ~= $text;
            while $rest.index(SEPARATOR).defined {
                $!updates.send($rest.substr(0, $rest.index(SEPARATOR)));
                $rest = $rest.substr($rest.index(SEPARATOR) + 1);
            }
        });
        $!process.start;
        self
    }

    method say($request) {
        await $!process.print($request ~ SEPARATOR);
    }

    # The first update that fits; a refusal ends the script.
    method wait-for(&fits) {
        my $end = now + 30;
        while now < $end {
            my $update = $!updates.poll // do { sleep 0.01; next };
            if $update ~~ /'"e":"failed"'/ {
                note "refused: $update";
                exit 1;
            }
            return $update if fits($update);
        }
        note 'nothing came in 30 s';
        exit 1;
    }
}

sub text-of($update, $key) { $update ~~ /'"' $key '":"' (<-["]>*) '"'/ ?? ~$0 !! '' }
sub number-of($update, $key) { $update ~~ /'"' $key '":' (<[-\d.e]>+)/ ?? +$0 !! 0 }

my $robot = Robot.new.connect;
$robot.say('{"c":"hello","name":"a Raku script"}');
my $hello = $robot.wait-for(*.contains('"e":"hello"'));
say "robot: {text-of($hello, 'device') || 'none'}";
$robot.say('{"c":"watch","topics":["status","pose"]}');
$robot.say('{"c":"start","id":1}');
$robot.wait-for({ .contains('"e":"done"') && .contains('"id":1') });
my $status = $robot.wait-for({ .contains('"e":"status"') && text-of($_, 'state') eq any('starting', 'cleaning') });
say "state: {text-of($status, 'state')}";
my $pose = $robot.wait-for(*.contains('"e":"pose"'));
say sprintf('place: %.2f m, %.2f m', number-of($pose, 'x'), number-of($pose, 'y'));
$robot.say('{"c":"stop","id":2}');
$robot.wait-for({ .contains('"e":"done"') && .contains('"id":2') });
say 'stopped';
exit 0;
