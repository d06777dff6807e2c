# The program in RAM that reads and writes flash for the programmer, a word in each transfer.
#
# A command is three words: command (an address, and what to do in its two lowest bits), argument, and the complement of their
# exclusive or. A command that is not whole, or a row whose sum is not the argument, ends in `lost`: the programmer sees that nothing
# is taken any more, enters again and repeats the page. So no word that was lost or doubled on the wire becomes a command.
#
#   0  read from a virtual address, argument words; after them come the two sums
#   1  program the row at a physical address with the 128 words that follow; argument: their second sum
#   2  erase the page at a physical address; argument 0
#   3  wait for the flash; argument 0
#
# 1, 2 and 3 answer with NVMCON as the operation *before* left it: the next row comes over the wire while the flash works.
# The sums of words w: first += w, second += first.

        lui     s3, 0xff20          # the probe's window
        lui     s4, 0xbf81          # the flash controller's registers lie below: NVMCON -0xc00, NVMKEY -0xbf0,
                                    # NVMADDR -0xbe0, NVMSRCADDR -0xbc0; SET is 8 above, CLR 4
        lui     s5, 0xa000
        ori     s5, s5, 0x1000      # one of two buffers for a row, 0x1000 and 0x1200
next:   lw      t0, 0(s3)           # command
        lw      a3, 0(s3)           # argument
        lw      t2, 0(s3)
        xor     t1, t0, a3
        nor     t1, t1, zero
        bne     t1, t2, lost
        andi    t3, t0, 3           # what to do
        addu    a1, zero, zero      # first sum
        addu    a2, zero, zero      # second sum
        beq     t3, zero, read
        xor     t0, t0, t3          # the address alone
        addiu   t4, t3, -1
        beq     t4, zero, row
        addiu   t4, t3, -2
        bne     t4, zero, finish
        ori     t7, zero, 0x4004    # WREN, erase page
        beq     zero, zero, operate
        nop

row:    xori    s5, s5, 0x200       # the flash may still read the other one
        addu    t6, s5, zero
        ori     t5, zero, 128
fill:   lw      t4, 0(s3)
        addiu   t5, t5, -1
        sw      t4, 0(t6)
        addu    a1, a1, t4
        addu    a2, a2, a1
        bne     t5, zero, fill
        addiu   t6, t6, 4
        bne     a2, a3, lost
        ori     t7, zero, 0x4003    # WREN, program row

operate: lw     t4, -0xc00(s4)
        andi    t5, t4, 0x8000      # WR: busy
        bne     t5, zero, operate
        nop
        sw      t0, -0xbe0(s4)
        andi    t5, s5, 0xffff      # the buffer's physical address
        sw      t5, -0xbc0(s4)
        sw      t7, -0xc00(s4)
        ori     t5, zero, 600       # 6 us for the detector of low voltage, at up to 80 MHz
settle: bne     t5, zero, settle
        addiu   t5, t5, -1
        lui     t6, 0xaa99
        ori     t6, t6, 0x6655
        lui     t7, 0x5566
        ori     t7, t7, 0x99aa
        ori     t5, zero, 0x8000
        sw      t6, -0xbf0(s4)
        sw      t7, -0xbf0(s4)
        sw      t5, -0xbf8(s4)
        beq     zero, zero, next
        sw      t4, 0(s3)

finish: lw      t4, -0xc00(s4)
        andi    t5, t4, 0x8000
        bne     t5, zero, finish
        ori     t5, zero, 0x4000
        sw      t5, -0xbfc(s4)      # WREN off
        beq     zero, zero, next
        sw      t4, 0(s3)

read:   lw      t4, 0(t0)
        addiu   t0, t0, 4
        sw      t4, 0(s3)
        addu    a1, a1, t4
        addiu   a3, a3, -1
        bne     a3, zero, read
        addu    a2, a2, a1
        sw      a1, 0(s3)
        beq     zero, zero, next
        sw      a2, 0(s3)

lost:   beq     zero, zero, lost
        nop
