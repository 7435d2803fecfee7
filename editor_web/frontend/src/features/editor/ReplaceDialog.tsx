/** What the selected nodes lose when they get another type, before it is lost. */
import { Box, Button, Code, Group, Stack, Table, Text } from '@mantine/core'
import { Dialog } from '../../components/Dialog'
import { nameOfPath } from '../../document/path'
import { FormWords } from './FormParts'
import { dropReplacement, performReplacement, usePendingReplacement } from './typeReplacement'

export function ReplaceDialog() {
  const pending = usePendingReplacement((s) => s.pending)
  if (!pending) return null
  const { to, losses } = pending
  return (
    <Dialog isOpen onClose={dropReplacement} title={`Replace by ${to.runs ?? to.kind}`}>
      <Stack gap="sm" miw="min(32rem, 80vw)">
        <Text size="sm">This does not fit and is lost:</Text>
        <Box mah="50vh" style={{ overflow: 'auto' }}>
          <Table fz="sm" aria-label="What is lost">
            <Table.Thead>
              <Table.Tr>
                <Table.Th>Node</Table.Th>
                <Table.Th>Lost</Table.Th>
                <Table.Th>Value</Table.Th>
                <Table.Th>Why</Table.Th>
              </Table.Tr>
            </Table.Thead>
            <Table.Tbody>
              {losses.map((loss) => (
                <Table.Tr key={`${loss.path} ${loss.item}`}>
                  <Table.Td title={loss.path}>{nameOfPath(loss.path)}</Table.Td>
                  <Table.Td>{plain(loss.item)}</Table.Td>
                  <Table.Td style={{ overflowWrap: 'anywhere' }}>
                    <Code bg="none" p={0}>
                      {loss.value}
                    </Code>
                  </Table.Td>
                  <Table.Td c="dimmed">{plain(loss.reason)}</Table.Td>
                </Table.Tr>
              ))}
            </Table.Tbody>
          </Table>
        </Box>
        <FormWords>Everything else is kept. Undo gives all of it back.</FormWords>
        <Group gap="xs">
          <Button variant="default" c="var(--failed)" bd="1px solid var(--failed)" onClick={() => void performReplacement(pending)}>
            Replace
          </Button>
          <Button variant="subtle" color="gray" c="dimmed" onClick={dropReplacement}>
            Keep it
          </Button>
        </Group>
      </Stack>
    </Dialog>
  )
}

function plain(text: string): string {
  return text.replaceAll('`', '')
}
