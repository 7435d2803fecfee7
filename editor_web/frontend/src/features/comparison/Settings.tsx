/** What two runs were started with, and the lines in which their documents differ. */
import { Box, Paper, Text, Title } from '@mantine/core'
import type { DocumentDifference, ValueChange } from '../../api/types'
import { DifferenceTable } from './DifferenceTable'

interface SettingsProps {
  readonly settings: readonly ValueChange[]
  readonly documents: readonly DocumentDifference[]
}

export function Settings({ settings, documents }: SettingsProps) {
  return (
    <Box px="md" pb="sm">
      <Title order={3} fz="0.84rem" mt="sm" mb="xs">
        Parameters, inputs, seed, clock
      </Title>
      {settings.length === 0 ? (
        <Text fz="sm" c="dimmed">
          Both runs were started with the same.
        </Text>
      ) : (
        <DifferenceTable rows={settings} name="Setting" />
      )}
      <Title order={3} fz="0.84rem" mt="sm" mb="xs">
        Documents
      </Title>
      {documents.length === 0 && (
        <Text fz="sm" c="dimmed">
          Both runs executed the same version.
        </Text>
      )}
      {documents.map((document) => (
        <section key={document.name} aria-label={`Differences of ${document.name}`}>
          <Text inherit ff="monospace">
            {document.name}
          </Text>
          <Paper
            component="pre"
            withBorder
            radius="sm"
            m={0}
            p="xs"
            bg="var(--ground)"
            fz="0.78rem"
            style={{ overflow: 'auto' }}
            tabIndex={0}
            aria-label={`Lines of ${document.name}`}
          >
            {document.lines.map((line, index) => (
              <Text key={index} component="span" inherit display="block" {...colorOf(line)}>
                {line}
              </Text>
            ))}
          </Paper>
        </section>
      ))}
    </Box>
  )
}

/** What only the left run has is red, what only the right one has green. */
function colorOf(line: string): { readonly c?: string } {
  if (line.startsWith('+')) return { c: 'var(--done)' }
  return line.startsWith('-') ? { c: 'var(--failed)' } : {}
}
