/** What a hot change has changed. */
import { Button, List, Text } from '@mantine/core'
import { Dialog } from '../../components/Dialog'
import type { Commands } from './useCommands'

export function ChangeReport({ commands }: { commands: Commands }) {
  const { report, forgetReport } = commands
  return (
    <Dialog isOpen={report !== undefined} onClose={forgetReport} title="The run continues with the current file">
      {report?.length === 0 && <Text size="sm">The file means the same as before.</Text>}
      <List size="sm">
        {report?.map((line) => (
          <List.Item key={line}>{line}</List.Item>
        ))}
      </List>
      <Text size="sm" c="var(--quiet)" my="sm">
        Nodes that are active keep the parameters they were entered with. Transitions, conditions and autonomy are those of the file at
        once.
      </Text>
      {/* oxlint-disable-next-line jsx-a11y/no-autofocus -- the only control of a modal dialog */}
      <Button onClick={forgetReport} autoFocus>
        Understood
      </Button>
    </Dialog>
  )
}
