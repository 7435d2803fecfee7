/** The file and the draft have both changed the same lines: which of them to go on with. */
import { Alert, Button, Code, Group, Text } from '@mantine/core'
import { folded, sideBySide } from '../../document/editing/textChange'
import { resolve } from './session'
import { cellEditor, draftOf, setCellEditor, useCellEditor } from './store'

export function ConflictNote({ onSaved }: { readonly onSaved: () => void }) {
  const theirs = useCellEditor((s) => s.conflict?.theirs)
  const mine = useCellEditor((s) => draftOf(s).text)
  if (theirs === undefined) return null
  const lines = folded(sideBySide(mine, theirs), 1).flatMap((line) =>
    line === undefined
      ? ['…']
      : line.isSame
        ? [`  ${line.left ?? ''}`]
        : [...(line.left === undefined ? [] : [`- ${line.left}`]), ...(line.right === undefined ? [] : [`+ ${line.right}`])],
  )
  return (
    <Alert color="yellow" radius={0} role="alert">
      <Text size="sm" fw={600}>
        The file has changed on disk
      </Text>
      <Text size="sm">
        Both have changed the same lines. Yours begin with -, those of the file with +; whatever you choose, both texts stay versions.
      </Text>
      <Code block my="xs" mah="30vh" style={{ overflow: 'auto' }} tabIndex={0} role="region" aria-label="Differences">
        {lines.join('\n')}
      </Code>
      <Group gap="xs">
        <Button size="xs" variant="default" onClick={() => void resolve('theirs').then(onSaved)}>
          Take the one on disk
        </Button>
        <Button
          size="xs"
          variant="default"
          c="var(--failed)"
          bd="1px solid var(--failed)"
          onClick={() => void resolve('mine').then(() => !cellEditor().conflict && onSaved())}
        >
          Overwrite with yours
        </Button>
        <Button size="xs" variant="subtle" color="gray" onClick={() => setCellEditor({ conflict: undefined })}>
          Go on editing
        </Button>
      </Group>
    </Alert>
  )
}
