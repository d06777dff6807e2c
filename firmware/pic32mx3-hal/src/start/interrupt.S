# Entry and exit of interrupts, and sleeping (section 5).
#
# k0 and k1 belong to this code: compiled code never uses them, but the next interrupt does, once it is let in.

    .equ FRAME,     112
    # 0 to 15: where the handler may spill its arguments, as the calling convention wants
    .equ AT,        16
    .equ V0,        20
    .equ V1,        24
    .equ A0,        28
    .equ A1,        32
    .equ A2,        36
    .equ A3,        40
    .equ T0,        44
    .equ T1,        48
    .equ T2,        52
    .equ T3,        56
    .equ T4,        60
    .equ T5,        64
    .equ T6,        68
    .equ T7,        72
    .equ T8,        76
    .equ T9,        80
    .equ RA,        84
    .equ LO,        88
    .equ HI,        92
    .equ EPC,       96
    .equ STATUS,    100
    .equ SRSCTL,    104

    .macro save_rest                        # all that a function may change, but t0 and t1
    sw      $at, AT($sp)
    sw      $v0, V0($sp)
    sw      $v1, V1($sp)
    sw      $a0, A0($sp)
    sw      $a1, A1($sp)
    sw      $a2, A2($sp)
    sw      $a3, A3($sp)
    sw      $t2, T2($sp)
    sw      $t3, T3($sp)
    sw      $t4, T4($sp)
    sw      $t5, T5($sp)
    sw      $t6, T6($sp)
    sw      $t7, T7($sp)
    sw      $t8, T8($sp)
    sw      $t9, T9($sp)
    sw      $ra, RA($sp)
    mflo    $t1
    mfhi    $t2
    sw      $t1, LO($sp)
    sw      $t2, HI($sp)
    .endm

    .macro load_rest
    lw      $t1, LO($sp)
    lw      $t2, HI($sp)
    mtlo    $t1
    mthi    $t2
    lw      $at, AT($sp)
    lw      $v0, V0($sp)
    lw      $v1, V1($sp)
    lw      $a0, A0($sp)
    lw      $a1, A1($sp)
    lw      $a2, A2($sp)
    lw      $a3, A3($sp)
    lw      $t2, T2($sp)
    lw      $t3, T3($sp)
    lw      $t4, T4($sp)
    lw      $t5, T5($sp)
    lw      $t6, T6($sp)
    lw      $t7, T7($sp)
    lw      $t8, T8($sp)
    lw      $t9, T9($sp)
    lw      $ra, RA($sp)
    .endm

    # In EIC mode the taken interrupt's level is in Cause.RIPL. k0 holds the handler.
    .section .vectors.entry, "ax"
    .globl __interrupt_entry
    .type __interrupt_entry, @function
__interrupt_entry:
    mfc0    $k1, $13
    addiu   $sp, $sp, -FRAME
    ext     $k1, $k1, 10, 6                 # RIPL
    sw      $t0, T0($sp)
    sltiu   $t0, $k1, 6
    beqz    $t0, 2f                         # level 6 stays at EXL = 1: nothing is above it
    sw      $t1, T1($sp)

    mfc0    $t0, $14                        # EPC
    mfc0    $t1, $12                        # Status
    sw      $t0, EPC($sp)
    sw      $t1, STATUS($sp)
    mfc0    $t0, $12, 2                     # SRSCtl
    ins     $t1, $k1, 10, 6                 # IPL = RIPL
    ins     $t1, $zero, 1, 4                # EXL, ERL and UM clear
    sw      $t0, SRSCTL($sp)
    move    $t0, $k0                        # a higher level will overwrite k0
    mtc0    $t1, $12                        # and may come in from here on
    save_rest
    jalr    $t0
    nop
    load_rest

    # Return to the beginning of __idle_begin instead of into it: the handler may have changed the word that was read.
    lw      $t0, EPC($sp)
    lui     $t1, %hi(__idle_begin)
    addiu   $t1, $t1, %lo(__idle_begin)
    subu    $t0, $t0, $t1
    sltiu   $t0, $t0, __idle_end - __idle_begin
    beqz    $t0, 1f
    lw      $t0, T0($sp)
    sw      $t1, EPC($sp)
1:  lw      $t1, T1($sp)
    di
    ehb
    lw      $k0, SRSCTL($sp)
    lw      $k1, EPC($sp)
    mtc0    $k0, $12, 2
    lw      $k0, STATUS($sp)
    mtc0    $k1, $14
    addiu   $sp, $sp, FRAME
    mtc0    $k0, $12                        # EXL is set in it: nothing comes in before the return
    ehb
    eret

2:  save_rest
    jalr    $k0
    nop
    load_rest
    lw      $t0, T0($sp)
    lw      $t1, T1($sp)
    addiu   $sp, $sp, FRAME
    eret

# __idle_begin(a0: address of a word): sleeps when the word is zero.
    .section .text.idle, "ax"
    .globl __idle_begin
    .type __idle_begin, @function
__idle_begin:
    lw      $v0, 0($a0)
    bnez    $v0, __idle_end
    nop
    wait
__idle_end:
    jr      $ra
    nop
