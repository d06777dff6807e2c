# The library seen from Raku, as the tests of 2016 saw it: callbacks in, a typed packet in, throttles and packets out.
#
# SPDX-License-Identifier: GPL-3.0-or-later
use v6;
use NativeCall;
use Test;

sub set_callback_get_time(&callback ( --> num64)) is native('cordlib') {...}
sub hw_get_time() returns num64 is native('cordlib') {...}
sub set_callback_get_time_ms(&callback ( --> uint32)) is native('cordlib') {...}
sub hw_get_time_ms() returns uint32 is native('cordlib') {...}
sub set_callback_setup(&callback ()) is native('cordlib') {...}
sub set_callback_set_motor_throttle(&callback (int32, num64)) is native('cordlib') {...}
sub cord_set_names(Str, Str) returns int32 is native('cordlib') {...}
sub cord_set_wheels(num64, num64, num64, num64) returns int32 is native('cordlib') {...}
sub cord_declare(Str, int32) returns int32 is native('cordlib') {...}
sub cord_init() returns int32 is native('cordlib') {...}
sub cord_step() returns int32 is native('cordlib') {...}
sub cord_inhibits() returns uint32 is native('cordlib') {...}
sub cord_event_bumper(num64, int32) is native('cordlib') {...}
sub cord_event_encoders(int32, int32) is native('cordlib') {...}
sub cord_connection_input_put(uint8) returns int32 is native('cordlib') {...}
sub cord_connection_output_pull() returns int32 is native('cordlib') {...}

my num64 $now = 4567.8e0;
set_callback_get_time sub ( --> num64) { $now };
is-approx hw_get_time(), 4567.8.Num, 'get_time() callback works';
is hw_get_time_ms(), 4567800, 'milliseconds come from seconds';

my $setups = 0;
my @throttle = 0 xx 5;
my @way = 0, 0;
set_callback_setup sub () { $setups++ };
set_callback_set_motor_throttle sub (int32 $motor, num64 $throttle) { @throttle[$motor] = $throttle };
is cord_set_names('raku-test', '1.0'), 1, 'names are taken';
is cord_set_wheels(0.23e0, 0.0005e0, 0.1e0, 0.4e0), 1, 'wheels are taken';
is cord_declare('bumpers', 2), 1, 'bumpers are declared';
is cord_init(), 1, 'initialised';
is $setups, 1, 'setup is called';

my $received = Buf.new;

sub run(Int $milliseconds) {
    for ^$milliseconds {
        $now = $now + 0.001e0;
        @way[$_] += @throttle[$_] * 0.4e-3 for ^2;
        cord_event_encoders((@way[0] / 0.0005).Int, (@way[1] / 0.0005).Int);
        cord_step();
        while (my $byte = cord_connection_output_pull()) >= 0 { $received.push($byte) }
    }
}

sub type-in(Str $packet) {
    cord_connection_input_put($_) for $packet.encode.list;
    cord_connection_input_put(0x1F);
    run 20;
}

sub crc32c(@bytes) {
    my $crc = 0xFFFFFFFF;
    for @bytes -> $byte {
        $crc = $crc +^ $byte;
        $crc = $crc +& 1 ?? ($crc +> 1) +^ 0x82F63B78 !! $crc +> 1 for ^8;
    }
    $crc +^ 0xFFFFFFFF
}

sub packets() {
    $received.decode('utf-8').split("\x1F").grep(*.chars).map: -> $packet {
        my ($text, $crc) = $packet.split('*');
        my @bytes = $text.encode.list;
        my @summed = flat '<'.ord, 0, 0, @bytes, @bytes.elems +& 0xFF, @bytes.elems +> 8;
        die "bad CRC: $packet" unless crc32c(@summed) == :16($crc);
        $text
    }
}

type-in '{"c":"arm","n":1,"undock":false}';
is cord_inhibits(), 0, 'armed';
type-in '{"c":"drive","v":0.05,"w":0,"ttl":500}';
run 150;
ok @throttle[0] > 0.1 && @throttle[1] > 0.1, 'a typed drive turns both wheels';
cord_event_bumper(-0.3e0, 1);
run 2;
is-deeply @throttle[0, 1].map(*.Num).List, (0e0, 0e0), 'a bump stops them at once';
run 60;
my @packets = packets();
ok @packets.first(*.contains('raku-test')), 'the robot says hello';
ok @packets.first(*.contains('"a":1')), 'arming is answered';
ok @packets.first(*.contains('"bump"')), 'the bump is reported';

done-testing;
