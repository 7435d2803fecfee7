/** The draft and the file side by side, where both have changed, and which of them to go on with as a whole. */
import { Button, Group, SimpleGrid, Stack } from '@mantine/core'
import { Dialog } from '../../components/Dialog'
import { LineDiff } from './LineDiff'
import { resolve } from './session'
import { draftOf, setEditor, useEditor } from './store'
import classes from './versions.module.css'

export function ConflictDialog() {
  const conflict = useEditor((s) => (s.isComparing ? s.conflict : undefined))
  const mine = useEditor((s) => draftOf(s).text)
  if (!conflict) return null
  const close = () => setEditor(conflict.merge ? { isComparing: false } : { isComparing: false, conflict: undefined, isOutdated: true })
  return (
    <Dialog isOpen onClose={close} title="The file has changed on disk">
      <Stack gap="sm" className={classes['wide']}>
        <SimpleGrid cols={2} fz="sm">
          <strong>Yours</strong>
          <strong>On disk</strong>
        </SimpleGrid>
        <LineDiff label="Differences, yours on the left" left={mine} right={conflict.theirs} />
        <Group gap={6}>
          <Button size="compact-sm" variant="default" onClick={() => void resolve('theirs')}>
            Take the one on disk
          </Button>
          <Button size="compact-sm" variant="default" c="var(--failed)" bd="1px solid var(--failed)" onClick={() => void resolve('mine')}>
            Overwrite with yours
          </Button>
          <Button size="compact-sm" variant="subtle" color="gray" c="dimmed" onClick={close}>
            {conflict.merge ? 'Back to the conflicts' : 'Go on editing'}
          </Button>
        </Group>
      </Stack>
    </Dialog>
  )
}
