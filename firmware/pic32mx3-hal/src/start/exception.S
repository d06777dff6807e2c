# Exceptions other than interrupts: the program is broken. Its registers go to __exception (exception.rs) on a fresh stack.

    .section .vectors.general, "ax"         # EBase + 0x180
    .globl __general_exception
    .type __general_exception, @function
__general_exception:
    move    $k0, $sp
    lui     $sp, %hi(__stack_top)
    addiu   $sp, $sp, %lo(__stack_top)
    addiu   $sp, $sp, -24                   # 16 for arguments in registers, then two more
    sw      $ra, 16($sp)
    sw      $k0, 20($sp)
    mfc0    $a0, $13                        # Cause
    mfc0    $a1, $14                        # EPC
    mfc0    $a2, $8                         # BadVAddr
    mfc0    $a3, $12                        # Status
    j       __exception
    nop

# The hook of a program that has none (link.x).
    .section .text.hook, "ax"
    .globl __default_exception_hook
    .type __default_exception_hook, @function
__default_exception_hook:
    j       __restart_far
    nop

# A vector without handler. It came through __interrupt_entry, or stands in for a function.
    .section .text.unhandled, "ax"
    .globl __unhandled_interrupt
    .type __unhandled_interrupt, @function
__unhandled_interrupt:
    j       __general_exception
    nop

    .section .bev_exception, "ax"           # 0xBFC00380, while Status.BEV is set
    lui     $k0, %hi(__restart)
    addiu   $k0, $k0, %lo(__restart)
    jr      $k0
    nop
