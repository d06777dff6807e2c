//! System calls of Linux for MIPS (o32), which the emulator's caller answers for the chip.

use core::arch::asm;
use core::panic::PanicInfo;
use pic32_proof::WORKS;

const WRITE: u32 = 4004;
const EXIT: u32 = 4001;
const STANDARD_OUTPUT: u32 = 1;

/// Does a round and writes its results.
pub(crate) fn round(number: u32) {
    let mut results = [0; WORKS.len()];
    pic32_proof::round(number, &mut results);
    call(
        WRITE,
        (
            STANDARD_OUTPUT,
            results.as_ptr() as u32,
            size_of_val(&results) as u32,
        ),
    );
}

/// Ends a process.
pub(crate) fn exit() {
    call(EXIT, (0, 0, 0));
}

fn call(number: u32, arguments: (u32, u32, u32)) {
    // SAFETY: `write` only reads the bytes named by address and length, which live until it returns, and `exit` reads
    // nothing; the registers that a system call may change are named.
    unsafe {
        asm!(
            "syscall",
            inlateout("$2") number => _,
            inlateout("$4") arguments.0 => _,
            inlateout("$5") arguments.1 => _,
            inlateout("$6") arguments.2 => _,
            lateout("$3") _, lateout("$7") _, lateout("$8") _, lateout("$9") _, lateout("$10") _, lateout("$11") _,
            lateout("$12") _, lateout("$13") _, lateout("$14") _, lateout("$15") _, lateout("$24") _, lateout("$25") _,
        );
    }
}

#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    loop {
        exit();
    }
}
