/** What two runs were started with, and the lines in which their documents differ. */
import { Box, Paper, Text, Title } from '@mantine/core'
import type { DocumentDifference, ValueChange } from '../../api/types'
import { DifferenceTable } from './DifferenceTable'
import styles from './comparison.module.css'

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
          <Text ff="monospace">{document.name}</Text>
          <Paper
            component="pre"
            withBorder
            radius="sm"
            m={0}
            p="xs"
            bg="var(--ground)"
            fz="0.78rem"
            className={styles.lines ?? ''}
            tabIndex={0}
            aria-label={`Lines of ${document.name}`}
          >
            {document.lines.map((line, index) => (
              <div key={index} data-side={line.startsWith('+') ? 'right' : line.startsWith('-') ? 'left' : undefined}>
                {line}
              </div>
            ))}
          </Paper>
        </section>
      ))}
    </Box>
  )
}
