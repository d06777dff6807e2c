# From reset to the program (section 4). Interrupts are off and every pin is an input until the program says otherwise.
#
# Wait states and the prefetch cache come before memory is filled, not after it as in the usual order: at seven wait states,
# uncached, that would take more than 3 ms.

    .equ STATUS_BEV,        0x00400000
    .equ CAUSE_IV,          0x00800000
    .equ VECTOR_SPACING,    1 << 5          # IntCtl.VS = 1: 32 bytes
    .equ CHECON,            0xBF884000      # section 7
    .equ CHECON_80_MHZ,     0x00000032      # 2 wait states, prefetch for cacheable and other regions
    .equ BMXCONCLR,         0xBF882004
    .equ BMX_RAM_WAIT,      1 << 6          # BMXWSDRM
    .equ DDPCONCLR,         0xBF80F204
    .equ DDPCON_JTAGEN,     1 << 3
    .equ SYSKEY,            0xBF80F230
    .equ RSWRST,            0xBF80F610
    .equ RSWRSTSET,         0xBF80F618
    .equ STACK_PAINT,       0x5AC1D0E5      # what unused stack holds; stack.rs has the same

    .section .reset, "ax"
    .globl __reset
    .type __reset, @function
__reset:
    mfc0    $k0, $12
    ext     $k0, $k0, 19, 1                 # Status.NMI: this is no reset
    bnez    $k0, __restart
    nop
    lui     $sp, %hi(__stack_top)
    addiu   $sp, $sp, %lo(__stack_top)
    lui     $gp, %hi(_gp)
    addiu   $gp, $gp, %lo(_gp)
    lui     $t0, %hi(STATUS_BEV)            # interrupts off, no level, ERL and EXL clear; vectors still in boot flash
    mtc0    $t0, $12
    ehb
    lui     $t0, %hi(__vectors)             # EBase is written while BEV is set
    addiu   $t0, $t0, %lo(__vectors)
    mtc0    $t0, $15, 1
    ehb
    li      $t0, VECTOR_SPACING
    mtc0    $t0, $12, 1
    li      $t0, -1                         # first match of the core timer as far away as can be
    mtc0    $t0, $11
    mtc0    $zero, $9
    lui     $t0, %hi(CAUSE_IV)              # vectors of their own for interrupts, Count runs
    mtc0    $t0, $13
    ehb

    lui     $t0, %hi(CHECON)
    li      $t1, CHECON_80_MHZ
    sw      $t1, %lo(CHECON)($t0)
    lui     $t0, %hi(BMXCONCLR)
    li      $t1, BMX_RAM_WAIT
    sw      $t1, %lo(BMXCONCLR)($t0)
    mfc0    $t0, $16                        # Config.K0 = 3: program flash through the prefetch cache
    li      $t1, 3
    ins     $t0, $t1, 0, 3
    mtc0    $t0, $16
    ehb
    lui     $t0, %hi(__start)               # from boot flash, uncached, to program flash, cached
    addiu   $t0, $t0, %lo(__start)
    jr      $t0
    nop

# Exceptions before the program's own vectors are in use, and non-maskable interrupts: nothing is known of memory, so the
# chip is reset. All pins are inputs from then on.
    .section .reset.exceptions, "ax"
    .globl __restart
    .type __restart, @function
__restart:
    di
    ehb
    lui     $k0, %hi(SYSKEY)
    sw      $zero, %lo(SYSKEY)($k0)
    li      $k1, 0xAA996655
    sw      $k1, %lo(SYSKEY)($k0)
    li      $k1, 0x556699AA
    sw      $k1, %lo(SYSKEY)($k0)
    lui     $k0, %hi(RSWRSTSET)
    li      $k1, 1
    sw      $k1, %lo(RSWRSTSET)($k0)
    lw      $k1, %lo(RSWRST)($k0)           # the reading is what starts it
1:  b       1b
    nop

    .section .text.start, "ax"
    .globl __start
    .type __start, @function
__start:
    jal     __pre_init
    nop

    # .data from flash, in words
    lui     $t0, %hi(__data_load)
    addiu   $t0, $t0, %lo(__data_load)
    lui     $t1, %hi(__data_start)
    addiu   $t1, $t1, %lo(__data_start)
    lui     $t2, %hi(__data_end)
    addiu   $t2, $t2, %lo(__data_end)
    beq     $t1, $t2, 2f
    nop
1:  lw      $t3, 0($t0)
    addiu   $t0, $t0, 4
    sw      $t3, 0($t1)
    addiu   $t1, $t1, 4
    bne     $t1, $t2, 1b
    nop

2:  # .bss
    lui     $t1, %hi(__bss_start)
    addiu   $t1, $t1, %lo(__bss_start)
    lui     $t2, %hi(__bss_end)
    addiu   $t2, $t2, %lo(__bss_end)
    beq     $t1, $t2, 4f
    nop
3:  addiu   $t1, $t1, 4
    bne     $t1, $t2, 3b
    sw      $zero, -4($t1)

4:  # the stack, painted, 16 bytes at a time; the linker script aligns both ends. Its lowest word is the canary.
    lui     $t1, %hi(__stack_bottom)
    addiu   $t1, $t1, %lo(__stack_bottom)
    lui     $t3, %hi(STACK_PAINT)
    addiu   $t3, $t3, %lo(STACK_PAINT)
5:  sw      $t3, 0($t1)
    sw      $t3, 4($t1)
    sw      $t3, 8($t1)
    addiu   $t1, $t1, 16
    bne     $t1, $sp, 5b
    sw      $t3, -4($t1)

    mtc0    $zero, $12                      # vectors in program flash; interrupts still off
    ehb
    addiu   $sp, $sp, -16                   # room for the arguments of the function that is called
    jal     __program
    nop
    j       __restart_far                   # the program does not return
    nop

# What runs before variables have values: JTAG gives back RA0, RA1, RA4 and RA5 (section 8). A program that is debugged over
# JTAG has a function __pre_init of its own that does not (link.x).
    .globl __default_pre_init
    .type __default_pre_init, @function
__default_pre_init:
    lui     $t0, %hi(DDPCONCLR)
    li      $t1, DDPCON_JTAGEN
    jr      $ra
    sw      $t1, %lo(DDPCONCLR)($t0)

    .globl __restart_far
__restart_far:
    lui     $t0, %hi(__restart)
    addiu   $t0, $t0, %lo(__restart)
    jr      $t0
    nop
