#!/usr/bin/env raku
# Lets a robot do something: raku robot.raku SOCKET [start|follow|drive|room [NUMBER]|rate]
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
        # Nothing comes after that; whoever waits is told.
        $!process.start.then({ $!updates.close });
        self
    }

    method say($request) {
        await $!process.print($request ~ SEPARATOR);
    }

    # The first update that fits; a refusal ends the script.
    method wait-for(&fits) {
        my $end = now + 30;
        while now < $end {
            my $update = $!updates.poll;
            without $update {
                exit 1 if $!updates.closed;
                sleep 0.01;
                next
            }
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

sub answered($number) {
    $robot.wait-for({ .contains('"e":"done"') && .contains("\"id\":$number") })
}
sub works() {
    my $status = $robot.wait-for({ .contains('"e":"status"') && text-of($_, 'state') eq any('starting', 'cleaning') });
    say "state: {text-of($status, 'state')}";
}
sub place-of($pose) { [number-of($pose, 'x'), number-of($pose, 'y')] }
sub stop() {
    $robot.say('{"c":"stop","id":2}');
    answered(2);
    say 'stopped';
}

my %jobs =
    # Starts it, follows it until it works, and stops it.
    start => {
        $robot.say('{"c":"watch","topics":["status","pose"]}');
        $robot.say('{"c":"start","id":1}');
        answered(1);
        works;
        say sprintf('place: %.2f m, %.2f m', |place-of($robot.wait-for(*.contains('"e":"pose"'))));
        stop;
    },
    # Says how old the newest telemetry is, five times.
    follow => {
        $robot.say('{"c":"watch","topics":["device"]}');
        say "telemetry: {number-of($robot.wait-for(*.contains('"e":"device"')), 'age_ms')} ms old" for ^5;
    },
    # Drives two seconds backwards at 0.1 m/s, as from its dock. The lease of 300 ms is renewed; who lets go stops.
    drive => {
        $robot.say('{"c":"watch","topics":["pose"]}');
        # It begins at rest.
        for |(0 xx 3), |(-0.1 xx 20) -> $speed {
            $robot.say('{"c":"drive","v":' ~ $speed ~ ',"w":0,"ttl":300}');
            sleep 0.1;
        }
        $robot.say('{"c":"stop","id":2}');
        my @poses;
        $robot.wait-for(-> $update {
            @poses.push(place-of($update)) if $update.contains('"e":"pose"');
            $update.contains('"e":"done"') && $update.contains('"id":2')
        });
        say 'stopped';
        my ($x, $y) = @poses[*-1].list Z- @poses[0].list;
        say sprintf('driven: %.2f m', sqrt($x² + $y²));
    },
    # Cleans the room of this number, or the first one that it knows.
    room => {
        $robot.say('{"c":"watch","topics":["home","status"]}');
        my $home = $robot.wait-for({ .contains('"e":"home"') && .contains('"rooms":[{') });
        my $room = @*ARGS[2] // number-of($home.substr($home.index('"rooms":[{')), 'id');
        $robot.say('{"c":"clean","parts":[{"room":' ~ $room ~ '}],"id":1}');
        answered(1);
        works;
        say "room: $room";
        stop;
    },
    # Says how many packets a second it understands, until another kind comes.
    rate => {
        my $begin = now;
        my $count = 0;
        for $robot.updates.list -> $update {
            last unless text-of($update, 'e') eq 'pose' && number-of($update, 'x').defined;
            $count++;
        }
        say "packets a second: {($count / (now - $begin)).round}";
    };

my $job = @*ARGS[1] // 'start';
if $job ne 'rate' {
    $robot.say('{"c":"hello","name":"a Raku script"}');
    my $hello = $robot.wait-for(*.contains('"e":"hello"'));
    say "robot: {text-of($hello, 'device') || 'none'}";
}
%jobs{$job}();
$robot.process.kill('TERM');
exit 0;
