/** The file and the draft have both changed: what each has, side by side, and which text to go on with. */
import { Button, Group, SimpleGrid, Stack, Text } from '@mantine/core'
import { useState } from 'react'
import { Dialog } from '../../components/Dialog'
import { LineDiff } from './LineDiff'
import { resolve, type Side } from './session'
import { draftOf, setEditor, useEditor } from './store'
import classes from './versions.module.css'

export function ConflictDialog() {
  const conflict = useEditor((s) => s.conflict)
  const mine = useEditor((s) => draftOf(s).text)
  const [against, setAgainst] = useState<Side>('theirs')
  if (!conflict) return null
  const right = against === 'merged' ? (conflict.merged ?? '') : conflict.theirs
  const isMergeable = conflict.merged !== null
  const close = () => setEditor({ conflict: undefined, isOutdated: true })
  return (
    <Dialog isOpen onClose={close} title="The file has changed on disk">
      <Stack gap="sm" className={classes['wide']}>
        <Text size="sm">
          {isMergeable
            ? 'Both sides changed different lines; they can be merged.'
            : 'Both sides changed the same lines. Nothing was written; choose which text to go on with.'}
        </Text>
        <SimpleGrid cols={2} fz="sm">
          <strong>Yours</strong>
          <div role="radiogroup" aria-label="Compare with">
            <Against label="On disk" side="theirs" now={against} onChoose={setAgainst} />
            {isMergeable && <Against label="Merged" side="merged" now={against} onChoose={setAgainst} />}
          </div>
        </SimpleGrid>
        <LineDiff label="Differences, yours on the left" left={mine} right={right} />
        <Group gap={6}>
          {isMergeable && (
            <Button size="compact-sm" onClick={() => void resolve('merged')}>
              Save the merged text
            </Button>
          )}
          <Button size="compact-sm" variant="default" onClick={() => void resolve('theirs')}>
            Take the one on disk
          </Button>
          <Button size="compact-sm" variant="default" c="var(--failed)" bd="1px solid var(--failed)" onClick={() => void resolve('mine')}>
            Overwrite with yours
          </Button>
          <Button size="compact-sm" variant="subtle" color="gray" c="dimmed" onClick={close}>
            Go on editing
          </Button>
        </Group>
      </Stack>
    </Dialog>
  )
}

function Against({ label, side, now, onChoose }: { label: string; side: Side; now: Side; onChoose: (side: Side) => void }) {
  return (
    <Button
      size="compact-sm"
      variant={side === now ? 'light' : 'subtle'}
      role="radio"
      aria-checked={side === now}
      onClick={() => onChoose(side)}
    >
      {label}
    </Button>
  )
}
